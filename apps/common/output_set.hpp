// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "shapemap/io/atomic_file.hpp"

/// The outputs of one run appear together or not at all.
namespace shapemap::cli {

/// Throws ConfigError when two of `paths`, or one and `input`, are the same file.
void check_distinct(const std::vector<std::string>& paths, const std::string& input);

/// Checks before the work that the outputs can be written and are distinct. Throws OutputError when a folder is missing
/// or closed, or when a file exists and `force` is false.
void check_outputs(const std::vector<std::string>& paths, const std::string& input, bool force);

/// Says whether nothing can be put in place afterwards: standard output ("-"), a device, a pipe.
bool is_stream(const std::string& path);

/// Compares files also through links; "-" is only itself.
bool same_file(const std::string& a, const std::string& b);

/// Tells OutputSet::commit() what to do when the run was interrupted before the first file is in place.
enum class IfInterrupted { kDropAll, kWriteAll };

class OutputSet {
 public:
  using Writer = std::function<void(const std::string& temporary_path)>;

  /// Without `force`, a file that appears while the outputs are made is not replaced.
  explicit OutputSet(bool force) : force_(force) {}

  /// Calls `write` with a path in the folder of `path` and with its ending. Throws OutputError.
  void add(const std::string& path, const Writer& write);
  /// Takes also "-" for standard output, a device or a pipe as `path`; those are written on commit.
  void add_text(const std::string& path, const std::string& content);
  /// Makes the folder unless it exists; without a commit it is removed together with its files.
  void add_folder(const std::string& path);
  /// Marks a file for removal once the others are in place.
  void remove(const std::string& path) { outdated_.push_back(path); }
  /// Moves everything to its place. When something fails, all is as it was before. Of runs that write to the same
  /// folder, one waits for the other, so that no map gets the scale of another. Throws Interrupted by the rule, and
  /// when an interrupt ends the wait for the reader of a pipe.
  void commit(IfInterrupted rule = IfInterrupted::kDropAll);

 private:
  class NewFolder {
   public:
    explicit NewFolder(std::string path) : path_(std::move(path)) {}
    ~NewFolder();
    NewFolder(const NewFolder&) = delete;
    NewFolder& operator=(const NewFolder&) = delete;
    void keep() { keep_ = true; }

   private:
    std::string path_;
    bool keep_ = false;
  };
  struct File {
    std::string path;
    std::unique_ptr<AtomicFile> file;
  };
  struct Stream {
    std::string path;
    std::string content;
  };
  void commit_files();

  bool force_;
  std::vector<std::unique_ptr<NewFolder>> folders_;  ///< precede the files, so that these are removed first
  std::vector<File> files_;
  std::vector<Stream> streams_;
  std::vector<std::string> outdated_;
};

}  // namespace shapemap::cli
