// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace shapemap {

/// A file that appears whole or not at all: write to `temporary_path()`, then `commit()`, which flushes to disk and
/// renames it to the final name. Without a commit, the temporary file is removed and an existing file stays as it was.
class AtomicFile {
 public:
  /// What commit() does when a file has the final name already.
  enum class IfExists { kReplace, kFail };

  /// Throws OutputError when the folder does not exist or cannot be written to. The temporary file lies in the same
  /// folder and keeps the ending of `path`, from which image writers choose their format.
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::string& temporary_path() const { return temporary_path_; }
  /// Throws OutputError when the content did not reach the disk, or the final name is taken and may not be.
  void commit(IfExists rule = IfExists::kReplace);
  /// Takes a commit back: what had the final name before has it again. For files that go together. Does nothing without
  /// a commit, and no more can be taken back after settle(), or where the file system cannot exchange two files.
  void roll_back();
  /// Removes what was replaced, which is kept until then for roll_back(). The destructor does it as well.
  void settle();

 private:
  enum class State {
    kPending,
    kNew,       ///< in place, where nothing was
    kReplaced,  ///< in place; the temporary name has what was there
    kSettled,   ///< in place, for good
  };
  void replace();
  void create();

  std::string path_;
  std::string temporary_path_;
  State state_ = State::kPending;
};

/// `content` as the whole file `path`. Throws OutputError.
void write_file(const std::string& path, const std::string& content);

}  // namespace shapemap
