// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "shapemap/mapper/mapper_options.hpp"
#include "shapemap/scan/scan.hpp"

/// The head of a state file says what its matches depend on.
namespace shapemap {

/// No header is longer than this.
inline constexpr std::size_t kMostHeaderBytes = 65536;

std::string state_header(const Log& log, const MappingOptions& options);

/// Returns why the matches of a file that begins with `found` are not those of a run with the header `expected`, or an
/// empty string when they are.
std::string header_difference(std::string_view found, std::string_view expected);

}  // namespace shapemap
