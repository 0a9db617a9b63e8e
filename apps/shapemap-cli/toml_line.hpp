// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace shapemap::cli {

/// One line of a flat TOML file.
struct TomlLine {
  std::string key;    ///< empty for a blank line or a comment
  std::string value;  ///< without quotes and escapes
  bool is_string = false;
};

/// Throws ConfigError for what is no `key = value` line; tables and arrays are not used in options files.
TomlLine parse_toml_line(const std::string& line);

/// `text` in double quotes with TOML's escapes.
std::string toml_string(const std::string& text);

}  // namespace shapemap::cli
