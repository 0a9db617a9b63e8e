// SPDX-License-Identifier: GPL-3.0-or-later
#include "toml_line.hpp"

#include <charconv>
#include <cstddef>
#include <cstdio>
#include <string_view>

#include "shapemap/core/errors.hpp"

namespace shapemap::cli {
namespace {

constexpr std::string_view kBlank = " \t\r";
// pairs of the letter after the backslash and its character
constexpr std::string_view kEscapes = "b\bt\tn\nf\fr\r\"\"\\\\";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

/// Reads what follows a backslash at text[at], a one-letter escape or \uXXXX below 0x80; moves `at` to its last
/// character.
char unescaped(std::string_view text, std::size_t& at) {
  if (++at >= text.size()) throw ConfigError("a string ends in a backslash");
  if (text[at] == 'u' && at + 4 < text.size()) {
    unsigned code = 0;
    const char* first = text.data() + at + 1;
    const auto [end, error] = std::from_chars(first, first + 4, code, 16);
    if (error != std::errc() || end != first + 4 || code >= 0x80) {
      throw ConfigError("only \\u0000 to \\u007F are known; write other characters as they are");
    }
    at += 4;
    return static_cast<char>(code);
  }
  for (std::size_t i = 0; i < kEscapes.size(); i += 2) {
    if (kEscapes[i] == text[at]) return kEscapes[i + 1];
  }
  throw ConfigError(std::string("unknown escape '\\") + text[at] + "' in a string");
}

/// Returns the string that `text` starts with; `rest` is what comes after its closing quote.
std::string quoted_string(std::string_view text, std::string_view& rest) {
  const char quote = text.front();
  std::string value;
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (text[i] == quote) {
      rest = trimmed(text.substr(i + 1));
      return value;
    }
    value += quote == '"' && text[i] == '\\' ? unescaped(text, i) : text[i];
  }
  throw ConfigError("a string without its closing quote");
}

}  // namespace

TomlLine parse_toml_line(const std::string& line) {
  const std::string_view text = trimmed(line);
  TomlLine parsed;
  if (text.empty() || text.front() == '#') return parsed;
  if (text.front() == '[') throw ConfigError("tables are not used here; write plain 'name = value' lines");
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) throw ConfigError("expected 'name = value', found '" + std::string(text) + "'");
  parsed.key = trimmed(text.substr(0, equals));
  if (parsed.key.empty()) throw ConfigError("a value without a name");
  std::string_view value = trimmed(text.substr(equals + 1));
  if (value.empty() || value.front() == '#') throw ConfigError("'" + parsed.key + "' has no value");

  parsed.is_string = value.front() == '"' || value.front() == '\'';
  std::string_view rest;
  if (parsed.is_string) {
    parsed.value = quoted_string(value, rest);
  } else {
    parsed.value = trimmed(value.substr(0, value.find('#')));
  }
  if (!rest.empty() && rest.front() != '#')
    throw ConfigError("unexpected text after the value of '" + parsed.key + "'");
  return parsed;
}

std::string toml_string(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += {'\\', c};
    } else if (code < 0x20 || code == 0x7F) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\u%04X", static_cast<unsigned>(code));
      quoted += escape;
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

}  // namespace shapemap::cli
