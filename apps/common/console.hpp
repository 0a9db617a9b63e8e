// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "shapemap/core/printable.hpp"
#include "shapemap/io/log_file.hpp"

namespace shapemap::cli {

inline constexpr std::size_t kMaxListed = 20;

/// To standard output. Throws OutputError when it does not take it.
void print_text(const std::string& text);

/// To stderr, with the program's name: one line whatever `text` holds, see core/printable.hpp.
void print_line(std::string_view text, std::size_t most = kMostShown);

/// To stderr, each line with the program's name and `prefix`; after `max_lines` only how many more there are, and
/// `where` to find them.
void print_lines(const std::string& prefix, const std::vector<std::string>& lines, std::size_t max_lines,
                 const std::string& where = ", see --report");

std::string log_summary_text(const LogSummary& summary);

}  // namespace shapemap::cli
