// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include "numbers.hpp"
#include "shapemap/core/options.hpp"

namespace shapemap::cli {

/// An entry gives access to one option as text. `text` and `set` refer to the struct that the table was made of.
struct OptionEntry {
  enum class Kind { kNumber, kInteger, kSwitch, kText, kChoice };

  std::string group;
  std::string name;
  std::string old_name;  ///< accepted as well; may be empty
  std::string help;
  Kind kind = Kind::kText;
  std::string allowed;                ///< limits or spellings, for the help
  std::function<std::string()> text;  ///< returns the text as it would be typed; "true" or "false" for a switch
  std::function<void(const std::string&)> set;  ///< throws ConfigError
};

using OptionTable = std::vector<OptionEntry>;

/// Accepts "true" or "false"; throws ConfigError for anything else.
bool parse_switch(const Field& field, const std::string& text);
std::string limits_text(const Field& field);

template <class Enum>
std::string spellings_text() {
  std::string all;
  for (const std::string_view name : EnumNames<Enum>::names) all += (all.empty() ? "" : ", ") + std::string(name);
  return all;
}

template <class Enum>
Enum parse_choice(const Field& field, const std::string& text) {
  try {
    return enum_from_name<Enum>(text);
  } catch (const ConfigError& e) {
    throw ConfigError("--" + std::string(field.name) + ": " + e.what());
  }
}

template <class Value>
OptionEntry make_entry(const std::string& group, const Field& field, Value& value) {
  using Kind = OptionEntry::Kind;
  OptionEntry entry{group, field.name, field.old_name, field.help, Kind::kText, "", {}, {}};
  if constexpr (std::is_same_v<Value, bool>) {
    entry.kind = Kind::kSwitch;
    entry.text = [&value] { return value ? "true" : "false"; };
    entry.set = [&value, field](const std::string& text) { value = parse_switch(field, text); };
  } else if constexpr (std::is_enum_v<Value>) {
    entry.kind = Kind::kChoice;
    entry.allowed = spellings_text<Value>();
    entry.text = [&value] { return enum_name(value); };
    entry.set = [&value, field](const std::string& text) { value = parse_choice<Value>(field, text); };
  } else if constexpr (std::is_same_v<Value, double>) {
    entry.kind = Kind::kNumber;
    entry.allowed = limits_text(field);
    entry.text = [&value, field] { return number_text(value, field.unit); };
    entry.set = [&value, field](const std::string& text) { value = parse_number(field, text); };
  } else if constexpr (std::is_same_v<Value, int>) {
    entry.kind = Kind::kInteger;
    entry.allowed = limits_text(field);
    entry.text = [&value] { return std::to_string(value); };
    entry.set = [&value, field](const std::string& text) { value = parse_integer(field, text); };
  } else {
    static_assert(std::is_same_v<Value, std::string>, "an option is a bool, int, double, string or named enum");
    entry.text = [&value] { return value; };
    entry.set = [&value](const std::string& text) { value = text; };
  }
  return entry;
}

template <class Options>
void append_options(OptionTable& table, const std::string& group, Options& options) {
  Options::fields(options, [&](const Field& field, auto& value) { table.push_back(make_entry(group, field, value)); });
}

/// Returns every option of `settings`, in the order of its groups. The table must not outlive `settings`.
template <class Settings>
OptionTable option_table(Settings& settings) {
  OptionTable table;
  Settings::groups(settings, [&](const char* title, auto& group) { append_options(table, title, group); });
  return table;
}

/// Returns the entry that is called `name`, now or before, or null.
const OptionEntry* find_option(const OptionTable& table, const std::string& name);

}  // namespace shapemap::cli
