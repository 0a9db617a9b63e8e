// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "arguments.hpp"
#include "log_set.hpp"
#include "output_set.hpp"
#include "shapemap/io/report.hpp"

/// What nothing ties to the map, each piece as a map of its own: fragment_N.png, .yaml and .tum.
namespace shapemap::cli {

/// Throws OutputError when nothing can be written there, or files of a former run would be replaced without `force`;
/// ConfigError when one of `others` (inputs and outputs) could be mistaken for a fragment.
void check_fragments_folder(const std::string& folder, const std::vector<std::string>& others, bool force);

/// Of each fragment but the largest. Those of a former run go. What the pictures show is added to `drawn`.
void add_fragments(const MapArguments& arguments, const LogSet& logs, const MapResult& result, OutputSet& outputs,
                   std::vector<DrawnComponent>& drawn);

}  // namespace shapemap::cli
