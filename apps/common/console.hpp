// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "shapemap/io/log_file.hpp"

namespace shapemap::cli {

inline constexpr std::size_t kMaxListed = 20;

/// To standard output. Throws OutputError when it does not take it.
void print_text(const std::string& text);

/// `text` as one line that a terminal can show: control characters and bytes that are no UTF-8 become '?'.
std::string printable(std::string text);

/// To stderr, each line with the program's name and `prefix`; after `max_lines` only how many more there are, and
/// `where` to find them.
void print_lines(const std::string& prefix, const std::vector<std::string>& lines, std::size_t max_lines,
                 const std::string& where = ", see --report");

std::string log_summary_text(const LogSummary& summary);

}  // namespace shapemap::cli
