// SPDX-License-Identifier: GPL-3.0-or-later
#include "numbers.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>

namespace shapemap::cli {
namespace {

std::string with_digits(double value, int digits) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

[[noreturn]] void refuse(const Field& field, const std::string& text, const char* what) {
  throw ConfigError("--" + std::string(field.name) + " is '" + text + "', expected " + what + " from " +
                    number_text(field.lowest, 1.0) + " to " + number_text(field.highest, 1.0));
}

/// Reads the whole of `text` as a number; a plus sign is allowed, as in TOML.
template <class Number>
bool read_number(const std::string& text, Number& value) {
  const char* first = text.data() + (text.size() > 1 && text[0] == '+' && text[1] != '-' ? 1 : 0);
  const char* last = text.data() + text.size();
  const auto [end, error] = std::from_chars(first, last, value);
  return error == std::errc() && end == last;
}

}  // namespace

std::string number_text(double stored, double unit) {
  const double shown = stored / unit;
  const double infinity = std::numeric_limits<double>::infinity();
  // Dividing by the unit and multiplying again may miss by a bit; then a neighbour does not.
  for (const double candidate : {shown, std::nextafter(shown, infinity), std::nextafter(shown, -infinity)}) {
    for (int digits = 6; digits <= 17; ++digits) {
      const std::string text = with_digits(candidate, digits);
      double back = 0.0;
      if (read_number(text, back) && back * unit == stored) return text;
    }
  }
  return with_digits(shown, 17);
}

double parse_number(const Field& field, const std::string& text) {
  double shown = 0.0;
  if (!read_number(text, shown) || !(field.lowest <= shown && shown <= field.highest)) refuse(field, text, "a number");
  return shown * field.unit;
}

int parse_integer(const Field& field, const std::string& text) {
  int value = 0;
  if (!read_number(text, value) || !(field.lowest <= value && value <= field.highest)) {
    refuse(field, text, "a whole number");
  }
  return value;
}

}  // namespace shapemap::cli
