// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace shapemap {

/// The file appears whole or not at all: write to `temporary_path()`, then `commit()`, which flushes it to disk and
/// renames it to the final name. Without a commit, the temporary file is removed and an existing file stays as it was.
class AtomicFile {
 public:
  /// The rule for commit() when a file has the final name already.
  enum class IfExists { kReplace, kFail };

  /// Creates the temporary file in the same folder; it keeps the ending of `path`, from which image writers choose
  /// their format. Throws OutputError when the folder does not exist or cannot be written to.
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::string& temporary_path() const { return temporary_path_; }
  /// Throws OutputError when the content did not reach the disk, or when the final name is taken and must not be
  /// replaced.
  void commit(IfExists rule = IfExists::kReplace);
  /// Undoes a commit, so that files that go together appear together: what had the final name before has it again. Does
  /// nothing without a commit, after settle(), or where the file system cannot exchange two files.
  void roll_back();
  /// Removes the replaced file, which is kept until then for roll_back(). The destructor does the same.
  void settle();

 private:
  enum class State {
    kPending,
    kNew,       ///< in place, where no file was
    kReplaced,  ///< in place; the temporary name has the former file
    kSettled,   ///< in place for good
  };
  void replace();
  void create();

  std::string path_;
  std::string temporary_path_;
  State state_ = State::kPending;
};

/// Writes `content` as the whole file `path`. Throws OutputError.
void write_file(const std::string& path, const std::string& content);

}  // namespace shapemap
