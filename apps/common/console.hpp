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

/// Writes to standard output. Throws OutputError when that fails.
void print_text(const std::string& text);

/// Writes one line, whatever `text` holds, to stderr after the program's name; see core/printable.hpp.
void print_line(std::string_view text, std::size_t most = kMostShown);

/// Writes each line to stderr after the program's name and `prefix`; after `max_lines` it only says how many more there
/// are, and `where` to find them.
void print_lines(const std::string& prefix, const std::vector<std::string>& lines, std::size_t max_lines,
                 const std::string& where = ", see --report");

std::string log_summary_text(const LogSummary& summary);

}  // namespace shapemap::cli
