// SPDX-License-Identifier: GPL-3.0-or-later
#include "options_file.hpp"

#include <cctype>
#include <fstream>
#include <set>

#include "shapemap/core/version.hpp"
#include "toml_line.hpp"

namespace shapemap::cli {
namespace {

bool takes_string(const OptionEntry& entry) {
  return entry.kind == OptionEntry::Kind::kText || entry.kind == OptionEntry::Kind::kChoice;
}

void apply_line(const OptionTable& table, const std::string& line, std::set<std::string>& seen) {
  const TomlLine parsed = parse_toml_line(line);
  if (parsed.key.empty()) return;
  const OptionEntry* entry = find_option(table, parsed.key);
  if (!entry) throw ConfigError("there is no option '" + parsed.key + "'");
  if (!seen.insert(entry->name).second) throw ConfigError("'" + parsed.key + "' is set twice");
  if (parsed.is_string != takes_string(*entry)) {
    throw ConfigError("'" + parsed.key + "' takes " +
                      (takes_string(*entry) ? "a string in quotes" : "a bare value, not a string in quotes"));
  }
  entry->set(parsed.value);
}

}  // namespace

void apply_options_file(const OptionTable& table, const std::string& path) {
  std::ifstream file(path);
  if (!file) throw ConfigError("cannot read the options file '" + path + "'");
  std::set<std::string> seen;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    try {
      apply_line(table, line, seen);
    } catch (const ConfigError& e) {
      throw ConfigError(path + ":" + std::to_string(number) + ": " + e.what());
    }
  }
  if (file.bad()) throw ConfigError("cannot read the options file '" + path + "'");
}

std::string options_file_text(const OptionTable& table) {
  std::string text = "# Options of shapemap " + std::string(kVersion) + "; use with --config.\n";
  std::string group;
  for (const OptionEntry& entry : table) {
    if (entry.group != group) text += "\n## " + entry.group + "\n";
    group = entry.group;
    text += "# " + entry.help + (entry.allowed.empty() ? "" : " (" + entry.allowed + ")") + "\n";
    text += entry.name + " = " + (takes_string(entry) ? toml_string(entry.text()) : entry.text()) + "\n";
  }
  return text;
}

}  // namespace shapemap::cli
