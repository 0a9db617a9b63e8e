// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "shapemap/io/atomic_file.hpp"

/// The outputs of one run appear together or not at all.
namespace shapemap::cli {

/// Throws ConfigError when two of `paths`, or one and `input`, are the same file.
void check_distinct(const std::vector<std::string>& paths, const std::string& input);

/// Before the work: whether the outputs could be written, and are distinct. Throws OutputError when a folder is missing
/// or closed, or a file exists and `force` is false.
void check_outputs(const std::vector<std::string>& paths, const std::string& input, bool force);

class OutputSet {
 public:
  using Writer = std::function<void(const std::string& temporary_path)>;

  /// Calls `write` with a path in the folder of `path` and with its ending. Throws OutputError.
  void add(const std::string& path, const Writer& write);
  /// `path` may also be "-" for standard output, a device or a pipe; those are written on commit.
  void add_text(const std::string& path, const std::string& content);
  /// Everything to its place. When something fails, what is new among the outputs is taken away again.
  /// Throws Interrupted when that was asked for before the first file is in place.
  void commit();

 private:
  struct File {
    std::string path;
    bool is_new;
    std::unique_ptr<AtomicFile> file;
  };
  struct Stream {
    std::string path;
    std::string content;
  };
  std::vector<File> files_;
  std::vector<Stream> streams_;
};

}  // namespace shapemap::cli
