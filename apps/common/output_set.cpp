// SPDX-License-Identifier: GPL-3.0-or-later
#include "output_set.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "shapemap/core/errors.hpp"
#include "signals.hpp"

namespace shapemap::cli {
namespace {

namespace fs = std::filesystem;

fs::file_status status_of(const std::string& path) {
  std::error_code ignored;
  return fs::status(path, ignored);
}

void write_stream(const std::string& path, const std::string& content) {
  errno = 0;
  std::FILE* stream = path == "-" ? stdout : std::fopen(path.c_str(), "wb");
  if (!stream && errno == EINTR && interrupted()) throw Interrupted();
  if (!stream) throw OutputError("cannot write '" + path + "': " + std::strerror(errno));
  const bool written = std::fwrite(content.data(), 1, content.size(), stream) == content.size();
  const bool flushed = std::fflush(stream) == 0;
  const int error = errno;
  if (stream != stdout) std::fclose(stream);
  if ((!written || !flushed) && error == EINTR && interrupted()) throw Interrupted();
  if (!written || !flushed) throw OutputError("cannot write '" + path + "': " + std::strerror(error));
}

void check_output(const std::string& path, bool force) {
  if (is_stream(path)) return;
  const fs::file_status status = status_of(path);
  if (fs::is_directory(status)) throw OutputError("cannot write '" + path + "': it is a folder");
  if (fs::exists(status) && !force) throw OutputError("'" + path + "' exists already; --force replaces it");
  fs::path folder = fs::path(path).parent_path();
  if (folder.empty()) folder = ".";
  if (!fs::is_directory(status_of(folder.string()))) {
    throw OutputError("cannot write '" + path + "': there is no folder '" + folder.string() + "'");
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    throw OutputError("cannot write '" + path + "': " + std::strerror(errno));
  }
}

/// Locks a folder while the files of one run move to their places. Where a folder cannot be locked, or is locked for
/// long, the run goes on without.
class FolderLock {
 public:
  explicit FolderLock(const std::string& folder)
      : descriptor_(::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    for (int i = 0; i < kTries && descriptor_ >= 0; ++i) {
      if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
      ::poll(nullptr, 0, kWait_ms);
    }
  }
  ~FolderLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  static constexpr int kWait_ms = 10;
  static constexpr int kTries = 500;

  int descriptor_;
};

/// Makes `message` name the file that the user knows, not the temporary one.
std::string with_name(std::string message, const std::string& temporary_path, const std::string& path) {
  const std::size_t at = message.find(temporary_path);
  return at == std::string::npos ? message : message.replace(at, temporary_path.size(), path);
}

}  // namespace

bool is_stream(const std::string& path) {
  if (path == "-") return true;
  const fs::file_status status = status_of(path);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

bool same_file(const std::string& a, const std::string& b) {
  if (a == "-" || b == "-") return a == b;
  std::error_code ignored;
  const auto full = [](const std::string& path) {
    std::error_code error;
    const fs::path resolved = fs::weakly_canonical(fs::absolute(path), error);
    return error ? fs::absolute(path).lexically_normal() : resolved;  // a folder on the way may not be entered
  };
  return full(a) == full(b) || fs::equivalent(a, b, ignored);
}

void check_distinct(const std::vector<std::string>& paths, const std::string& input) {
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (same_file(paths[i], input)) throw ConfigError("'" + paths[i] + "' is both input and output");
    for (std::size_t j = 0; j < i; ++j) {
      if (same_file(paths[i], paths[j])) throw ConfigError("'" + paths[i] + "' is given for two outputs");
    }
  }
}

void check_outputs(const std::vector<std::string>& paths, const std::string& input, bool force) {
  check_distinct(paths, input);
  for (const std::string& path : paths) check_output(path, force);
}

void OutputSet::add(const std::string& path, const Writer& write) {
  if (is_stream(path)) throw OutputError("cannot write '" + path + "': this output needs a file");
  files_.push_back({path, std::make_unique<AtomicFile>(path)});
  const std::string& temporary_path = files_.back().file->temporary_path();
  clean_up_in(fs::path(temporary_path).parent_path().string());
  try {
    write(temporary_path);
  } catch (const OutputError& e) {
    throw OutputError(with_name(e.what(), temporary_path, path));
  }
}

void OutputSet::add_text(const std::string& path, const std::string& content) {
  if (is_stream(path)) {
    streams_.push_back({path, content});
  } else {
    add(path, [&](const std::string& temporary_path) { write_file(temporary_path, content); });
  }
}

OutputSet::NewFolder::~NewFolder() {
  if (!keep_) ::rmdir(path_.c_str());
}

void OutputSet::add_folder(const std::string& path) {
  if (fs::is_directory(status_of(path))) return;
  if (::mkdir(path.c_str(), 0777) != 0) throw OutputError("cannot make folder '" + path + "': " + std::strerror(errno));
  folders_.push_back(std::make_unique<NewFolder>(path));
  clean_up_in(path, true);
}

void OutputSet::commit_files() {
  if (files_.empty()) return;
  const FolderLock lock(fs::path(files_.front().path).parent_path().string());
  const auto rule = force_ ? AtomicFile::IfExists::kReplace : AtomicFile::IfExists::kFail;
  try {
    for (const File& file : files_) file.file->commit(rule);
  } catch (...) {
    for (const File& file : files_) file.file->roll_back();
    throw;
  }
  for (const File& file : files_) file.file->settle();
}

void OutputSet::commit(IfInterrupted rule) {
  // Streams come first: they cannot be taken back, and the files need nothing but a rename any more.
  for (const Stream& stream : streams_) write_stream(stream.path, stream.content);
  if (interrupted() && rule == IfInterrupted::kDropAll) throw Interrupted();
  set_interrupt_policy(OnInterrupt::kFinishAll);
  commit_files();
  for (const auto& folder : folders_) folder->keep();
  for (const std::string& path : outdated_) {
    std::error_code ignored;
    fs::remove(path, ignored);
  }
}

}  // namespace shapemap::cli
