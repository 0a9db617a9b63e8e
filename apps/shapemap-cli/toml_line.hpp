// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace shapemap::cli {

/// A line of a flat TOML file has a key and a value.
struct TomlLine {
  std::string key;    ///< empty for a blank line or a comment
  std::string value;  ///< without quotes and escapes
  bool is_string = false;
};

/// Throws ConfigError for a text that is no `key = value` line; options files use no tables and arrays.
TomlLine parse_toml_line(const std::string& line);

/// Returns `text` in double quotes with TOML's escapes.
std::string toml_string(const std::string& text);

}  // namespace shapemap::cli
