// SPDX-License-Identifier: GPL-3.0-or-later
#include "option_table.hpp"

#include <algorithm>

namespace shapemap::cli {

bool parse_switch(const Field& field, const std::string& text) {
  if (text == "true" || text == "false") return text == "true";
  throw ConfigError("--" + std::string(field.name) + " is '" + text + "', expected true or false");
}

std::string limits_text(const Field& field) {
  return number_text(field.lowest, 1.0) + " to " + number_text(field.highest, 1.0);
}

const OptionEntry* find_option(const OptionTable& table, const std::string& name) {
  const auto found = std::find_if(table.begin(), table.end(), [&](const OptionEntry& entry) {
    return entry.name == name || (!name.empty() && entry.old_name == name);
  });
  return found == table.end() ? nullptr : &*found;
}

}  // namespace shapemap::cli
