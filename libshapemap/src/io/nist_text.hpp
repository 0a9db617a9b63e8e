// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

#include "log_formats.hpp"
#include "text.hpp"

/// The two text forms of multi-scan logs: "shapemap-scans", which says everything, and bare lines of numbers.
namespace shapemap {

inline constexpr std::string_view kNistName = "shapemap-scans";
inline constexpr long long kNistVersion = 2;  ///< version 1 is the same without what it cannot say

/// Reads a bare log, one sub-scan a line, whose geometry is all in `options`.
Log read_bare(ByteSource& source, const LogReadOptions& options);

}  // namespace shapemap
