// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/io/numbers.hpp"

#include <type_traits>

#include "graph/graph_numbers.hpp"
#include "inference/inference_numbers.hpp"
#include "json_parts.hpp"
#include "localization/localization_numbers.hpp"
#include "loops/loops_numbers.hpp"
#include "mapper/mapper_numbers.hpp"
#include "matching/matching_numbers.hpp"

namespace shapemap {
namespace {

/// Adds the numbers of one room to `all`.
template <class Table>
void add_room(const char* room, const Table& table, std::vector<MethodNumber>& all) {
  Table::groups(table, [&](const char* group, const char* title, const auto& numbers) {
    std::decay_t<decltype(numbers)>::fields(numbers, [&](const NumberField& field, const auto& value) {
      using Value = std::decay_t<decltype(value)>;
      const auto add = [&](const std::string& name, double number) {
        all.push_back({room, group, title, name, number, std::is_integral_v<Value>, field.help, field.reason});
      };
      if constexpr (std::is_same_v<Value, PoseTolerance>) {
        add(field.name + std::string("_m"), value.m);
        add(field.name + std::string("_rad"), value.rad);
      } else {
        add(field.name, static_cast<double>(value));
      }
    });
  });
}

}  // namespace

std::vector<MethodNumber> method_numbers() {
  std::vector<MethodNumber> all;
  add_room("matching", kMatching, all);
  add_room("graph", kGraph, all);
  add_room("loops", kLoops, all);
  add_room("inference", kInference, all);
  add_room("localization", kLocalization, all);
  add_room("mapper", kMapper, all);
  return all;
}

std::string method_numbers_json() {
  Json all = Json::array();
  for (const MethodNumber& number : method_numbers()) {
    Json value = number.value;
    if (number.is_whole) value = static_cast<long>(number.value);
    all.push_back({{"room", number.room},
                   {"group", number.group},
                   {"title", number.title},
                   {"name", number.name},
                   {"value", value},
                   {"help", number.help},
                   {"fitted_to", number.reason}});
  }
  return all.dump(1) + "\n";
}

}  // namespace shapemap
