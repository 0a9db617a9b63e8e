// SPDX-License-Identifier: GPL-3.0-or-later
#include "leftovers.hpp"

#include <unistd.h>

#include <filesystem>
#include <system_error>
#include <vector>

namespace shapemap::cli {
namespace {

namespace fs = std::filesystem;

/// Recognises `.NAME.PID-COUNT`, with or without an ending; NAME may be one of these itself.
bool is_ours(const std::string& name) {
  const std::string mark = "." + std::to_string(::getpid()) + "-";
  const std::size_t at = name.rfind(mark);
  if (name.empty() || name.front() != '.' || at == std::string::npos || at == 0) return false;
  const std::size_t digits = at + mark.size();
  const std::size_t end = name.find_first_not_of("0123456789", digits);
  if (end == digits || digits == name.size()) return false;
  return end == std::string::npos || (name[end] == '.' && name.find('.', end + 1) == std::string::npos);
}

}  // namespace

void remove_temporary_files(const std::string& folder) {
  std::error_code ignored;
  std::vector<fs::path> found;
  const fs::directory_iterator end;
  for (fs::directory_iterator entry(folder.empty() ? "." : folder, ignored); entry != end; entry.increment(ignored)) {
    if (ignored) break;
    if (is_ours(entry->path().filename().string())) found.push_back(entry->path());
  }
  for (const fs::path& path : found) fs::remove(path, ignored);
}

}  // namespace shapemap::cli
