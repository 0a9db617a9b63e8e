// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace shapemap {

/// A file that appears whole or not at all: write to `temporary_path()`, then `commit()`, which flushes to disk and
/// renames it to the final name. Without a commit, the temporary file is removed and an existing file stays as it was.
class AtomicFile {
 public:
  /// Throws OutputError when the folder does not exist or cannot be written to. The temporary file lies in the same
  /// folder and keeps the ending of `path`, from which image writers choose their format.
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::string& temporary_path() const { return temporary_path_; }
  /// Throws OutputError when the content did not reach the disk.
  void commit();

 private:
  std::string path_;
  std::string temporary_path_;
  bool committed_ = false;
};

/// `content` as the whole file `path`. Throws OutputError.
void write_file(const std::string& path, const std::string& content);

}  // namespace shapemap
