// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/core/options.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <limits>
#include <string>

#include "shapemap/mapper/mapper_options.hpp"

namespace shapemap {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

enum class Colour { kRed, kDarkBlue };

struct SampleOptions {
  double share = 0.5;
  double turn_rad = 10 * kDegree;
  int count = 3;
  bool on = true;
  Colour colour = Colour::kRed;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"share", "a share", 0.25, 1}, self.share);
    visit(Field{"turn-deg", "an angle [deg]", -90, 90, kDegree}, self.turn_rad);
    visit(Field{"count", "a number", 1, 7}, self.count);
    visit(Field{"on", "a switch"}, self.on);
    visit(Field{"colour", "a choice"}, self.colour);
  }
};

/// Returns what validate() complains of after `change`; "" when it accepts the options.
std::string complaint(const std::function<void(SampleOptions&)>& change) {
  SampleOptions options;
  change(options);
  try {
    validate(options);
    return "";
  } catch (const ConfigError& error) {
    return error.what();
  }
}

}  // namespace

template <>
struct EnumNames<Colour> {
  static constexpr std::array<std::string_view, 2> names{"red", "dark-blue"};
};

namespace {

TEST(Options, AtTheirLimitsAreValid) {
  EXPECT_EQ(complaint([](SampleOptions& o) { o.share = 0.25; }), "");
  EXPECT_EQ(complaint([](SampleOptions& o) { o.share = 1.0; }), "");
  EXPECT_EQ(complaint([](SampleOptions& o) { o.count = 1; }), "");
  EXPECT_EQ(complaint([](SampleOptions& o) { o.count = 7; }), "");
}

TEST(Options, BeyondALimitAreRefusedByNameValueAndLimits) {
  EXPECT_EQ(complaint([](SampleOptions& o) { o.share = 0.2; }), "--share is 0.2, expected 0.25 to 1");
  EXPECT_EQ(complaint([](SampleOptions& o) { o.share = 1.001; }), "--share is 1.001, expected 0.25 to 1");
  EXPECT_EQ(complaint([](SampleOptions& o) { o.count = 0; }), "--count is 0, expected 1 to 7");
  EXPECT_EQ(complaint([](SampleOptions& o) { o.count = 8; }), "--count is 8, expected 1 to 7");
}

TEST(Options, ThatAreNoNumbersAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_THAT(complaint([&](SampleOptions& o) { o.share = nan; }), HasSubstr("--share is nan"));
  EXPECT_THAT(complaint([&](SampleOptions& o) { o.share = inf; }), HasSubstr("--share is inf"));
  EXPECT_THAT(complaint([&](SampleOptions& o) { o.turn_rad = -inf; }), HasSubstr("--turn-deg is -inf"));
}

TEST(Options, InDegreesHaveTheirLimitsInDegrees) {
  EXPECT_EQ(complaint([](SampleOptions& o) { o.turn_rad = 90 * kDegree; }), "");
  EXPECT_EQ(complaint([](SampleOptions& o) { o.turn_rad = -90 * kDegree; }), "");
  EXPECT_EQ(complaint([](SampleOptions& o) { o.turn_rad = 91 * kDegree; }), "--turn-deg is 91, expected -90 to 90");
}

TEST(Options, SwitchesAndChoicesHaveNoLimits) {
  EXPECT_EQ(complaint([](SampleOptions& o) {
              o.on = false;
              o.colour = Colour::kDarkBlue;
            }),
            "");
}

TEST(EnumNames, GoBothWays) {
  EXPECT_EQ(enum_name(Colour::kDarkBlue), "dark-blue");
  EXPECT_EQ(enum_from_name<Colour>("dark-blue"), Colour::kDarkBlue);
  EXPECT_EQ(enum_from_name<Colour>("red"), Colour::kRed);
}

TEST(EnumNames, AnUnknownOneIsToldTheSpellingsThatExist) {
  for (const char* wrong : {"green", "Red", "", "red ", "dark blue"}) {
    try {
      enum_from_name<Colour>(wrong);
      ADD_FAILURE() << "accepted '" << wrong << "'";
    } catch (const ConfigError& error) {
      EXPECT_THAT(error.what(), AllOf(HasSubstr("'" + std::string(wrong) + "'"), HasSubstr("red, dark-blue")));
    }
  }
}

TEST(MappingOptions, DefaultsAreWithinTheirLimits) { EXPECT_NO_THROW(validate_all(MappingOptions{})); }

TEST(MappingOptions, EveryNumberHasLimitsThatAreEnforcedOnBothSides) {
  // For each field, the same options are tried with only that field beyond a limit.
  int num_numbers = 0;
  MappingOptions options;
  MappingOptions::groups(options, [&](const char*, auto& group) {
    std::decay_t<decltype(group)>::fields(group, [&](const Field& field, auto& value) {
      using Value = std::decay_t<decltype(value)>;
      if constexpr (!std::is_same_v<Value, bool> && std::is_arithmetic_v<Value>) {
        ++num_numbers;
        const Value good = value;
        const double beyond = 0.01 * (1.0 + std::abs(field.lowest));
        value = static_cast<Value>((field.lowest - beyond) * field.unit - (std::is_integral_v<Value> ? 1 : 0));
        EXPECT_THROW(validate_all(options), ConfigError) << field.name << " too low";
        if constexpr (std::is_floating_point_v<Value>) {
          value = field.highest * 1.01 * field.unit;
          EXPECT_THROW(validate_all(options), ConfigError) << field.name << " too high";
        }
        value = good;
      }
    });
  });
  EXPECT_GT(num_numbers, 20);
}

TEST(MappingOptions, StrictPaperTurnsEveryReadingBack) {
  MappingOptions options;
  options.shape.points = ShapePoints::kResampled;
  options.paper.histogram.norm = HistogramNorm::kMaximum;
  options.paper.lcs.target = LcsTarget::kPerScan;
  options.paper.overlap.rule = OverlapRule::kNearest;
  options.paper.icp.gate = IcpGate::kFactor;
  make_strict_paper(options);
  EXPECT_EQ(options.shape.points, ShapePoints::kBeams);
  EXPECT_EQ(options.paper.histogram.norm, HistogramNorm::kCount);
  EXPECT_EQ(options.paper.lcs.target, LcsTarget::kConcatenated);
  EXPECT_EQ(options.paper.overlap.rule, OverlapRule::kAny);
  EXPECT_EQ(options.paper.icp.gate, IcpGate::kSlack);
}

}  // namespace
}  // namespace shapemap
