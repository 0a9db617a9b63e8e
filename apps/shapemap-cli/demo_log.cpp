// SPDX-License-Identifier: GPL-3.0-or-later
#include "demo_log.hpp"

#include <filesystem>

#include "shapemap/core/errors.hpp"

namespace shapemap::cli {

std::string demo_log_path() {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path program_folder = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  const fs::path installed = (program_folder / SHAPEMAP_DATA_FROM_BIN / "nist_arena.rawlog").lexically_normal();
  const fs::path in_source_tree = fs::path(SHAPEMAP_SOURCE_DATASETS) / "nist_arena.rawlog";
  for (const fs::path& path : {installed, in_source_tree}) {
    if (fs::is_regular_file(path, ignored)) return path.string();
  }
  throw InputError("the demo log is neither at '" + installed.string() + "' nor at '" + in_source_tree.string() + "'");
}

}  // namespace shapemap::cli
