// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

/// A process that leaves in the middle of its work would leave files behind.
namespace shapemap::cli {

/// Removes the temporary files of AtomicFile that this process has in `folder`.
void remove_temporary_files(const std::string& folder);

}  // namespace shapemap::cli
