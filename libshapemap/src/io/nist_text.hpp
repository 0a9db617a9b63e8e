// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

#include "log_formats.hpp"
#include "text.hpp"

/// Logs with several sweeps per scan have two text forms: "shapemap-scans", which states everything, and bare lines of
/// numbers.
namespace shapemap {

inline constexpr std::string_view kNistName = "shapemap-scans";
inline constexpr long long kNistVersion = 2;  ///< version 1 lacks some fields

/// Reads a bare log, one sweep a line, whose geometry is all in `options`.
Log read_bare(ByteSource& source, const LogReadOptions& options);

}  // namespace shapemap
