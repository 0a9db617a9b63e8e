// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace shapemap::cli {

/// Finds the demo log beside an installed program, or else in the source tree it was built from. Throws InputError.
std::string demo_log_path();

}  // namespace shapemap::cli
