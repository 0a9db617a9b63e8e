// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/io/numbers.hpp"

#include <gmock/gmock.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "graph/graph_numbers.hpp"
#include "inference/inference_numbers.hpp"
#include "localization/localization_numbers.hpp"
#include "loops/loops_numbers.hpp"
#include "mapper/mapper_numbers.hpp"
#include "matching/matching_numbers.hpp"

namespace shapemap {
namespace {

struct Anything {
  template <class T>
  operator T() const;  // NOLINT(google-explicit-constructor): it stands for any member
};

template <class T, std::size_t... I>
auto can_be_made_of(std::index_sequence<I...>) -> decltype(T{(static_cast<void>(I), Anything{})...}, std::true_type{});
template <class T>
std::false_type can_be_made_of(...);

/// How many members an aggregate has: as many as it can be made of, and no more.
template <class T, std::size_t N = 1>
constexpr std::size_t num_members() {
  if constexpr (decltype(can_be_made_of<T>(std::make_index_sequence<N + 1>{}))::value) {
    return num_members<T, N + 1>();
  } else {
    return N;
  }
}

struct Three {
  double a = 1.0;
  PoseTolerance b{1.0, 2.0};
  int c = 3;
};
static_assert(num_members<Three>() == 3);
static_assert(num_members<PoseTolerance>() == 2);

/// Calls `visit(group, numbers)` for each group of each room.
template <class Visit>
void for_each_group(const Visit& visit) {
  const auto visit_all = [&](const auto& table) {
    std::size_t num_groups = 0;
    std::decay_t<decltype(table)>::groups(table, [&](const char* group, const char*, const auto& numbers) {
      ++num_groups;
      visit(group, numbers);
    });
    EXPECT_EQ(num_groups, num_members<std::decay_t<decltype(table)>>());
  };
  visit_all(kMatching);
  visit_all(kGraph);
  visit_all(kLoops);
  visit_all(kInference);
  visit_all(kLocalization);
  visit_all(kMapper);
}

TEST(MethodNumbers, OfAllMembersOfAllTablesAreTold) {
  std::size_t num_groups = 0;
  for_each_group([&](const char* group, const auto& numbers) {
    using Numbers = std::decay_t<decltype(numbers)>;
    ++num_groups;
    std::set<const void*> members;
    std::set<std::string> names;
    Numbers::fields(numbers, [&](const NumberField& field, const auto& value) {
      const auto* at = reinterpret_cast<const char*>(&value);
      const auto* start = reinterpret_cast<const char*>(&numbers);
      EXPECT_TRUE(start <= at && at < start + sizeof(numbers)) << group << " " << field.name;
      members.insert(&value);
      names.insert(field.name);
    });
    EXPECT_EQ(members.size(), num_members<Numbers>()) << group;
    EXPECT_EQ(names.size(), num_members<Numbers>()) << group;
  });
  EXPECT_GT(num_groups, 30U);
}

TEST(MethodNumbers, AreWhatTheCodeReads) {
  std::map<std::string, MethodNumber> by_name;
  for (const MethodNumber& number : method_numbers()) {
    const std::string name = number.room + "." + number.group + "." + number.name;
    EXPECT_TRUE(by_name.emplace(name, number).second) << name;
    EXPECT_FALSE(number.help.empty()) << name;
    EXPECT_FALSE(number.reason.empty()) << name;
  }
  EXPECT_EQ(by_name.at("matching.score.agree").value, kMatching.score.agree);
  EXPECT_EQ(by_name.at("loops.clusters.same_rad").value, kLoops.clusters.same.rad);
  EXPECT_EQ(by_name.at("matching.line_noise.tangent").value, LineNoise().tangent);
  EXPECT_TRUE(by_name.at("mapper.updates.most_waiting").is_whole);
  EXPECT_FALSE(by_name.at("mapper.tracking.dense").is_whole);
}

TEST(MethodNumbers, ComeBackFromJsonToTheLastBit) {
  const std::vector<MethodNumber> numbers = method_numbers();
  const nlohmann::json told = nlohmann::json::parse(method_numbers_json());
  ASSERT_EQ(told.size(), numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    EXPECT_EQ(told[i].at("name"), numbers[i].name);
    EXPECT_EQ(told[i].at("value").get<double>(), numbers[i].value) << numbers[i].name;
    EXPECT_EQ(told[i].at("value").is_number_integer(), numbers[i].is_whole) << numbers[i].name;
    EXPECT_EQ(told[i].at("fitted_to"), numbers[i].reason);
  }
}

}  // namespace
}  // namespace shapemap
