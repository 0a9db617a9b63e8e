// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "shapemap/core/options.hpp"

/// Option values are written such that text -> value -> text gives the same text.
namespace shapemap::cli {

/// Returns the shortest text for `stored / unit` that `parse_number` takes back to the very same stored value.
std::string number_text(double stored, double unit);

/// Returns the stored value of `text`. Throws ConfigError when it is no number or outside of the field's limits.
double parse_number(const Field& field, const std::string& text);
int parse_integer(const Field& field, const std::string& text);

}  // namespace shapemap::cli
