// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "arguments.hpp"
#include "log_set.hpp"
#include "output_set.hpp"
#include "shapemap/io/report.hpp"

/// Each component that nothing connects to the map becomes a map of its own: fragment_N.png, .yaml and .tum.
namespace shapemap::cli {

/// Throws OutputError when nothing can be written there, or files of a former run would be replaced without `force`;
/// ConfigError when one of `others` (inputs and outputs) could be mistaken for such a file.
void check_fragments_folder(const std::string& folder, const std::vector<std::string>& others, bool force);

/// Adds the files of each component but the largest, and removes those of a former run. Adds to `drawn` what the
/// pictures show.
void add_component_files(const MapArguments& arguments, const LogSet& logs, const MapResult& result, OutputSet& outputs,
                         std::vector<DrawnComponent>& drawn);

}  // namespace shapemap::cli
