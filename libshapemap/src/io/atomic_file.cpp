// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/io/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>

#include "shapemap/core/errors.hpp"

namespace shapemap {
namespace {

[[noreturn]] void fail(const std::string& path, const char* what, int error) {
  throw OutputError(path + ": " + what + ": " + std::strerror(error));
}

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  bool ok() const { return fd_ >= 0; }
  int get() const { return fd_; }
  int release() { return std::exchange(fd_, -1); }

 private:
  int fd_;
};

/// Returns the file that a symbolic link leads to, so that the link itself stays.
std::string resolved(const std::string& path) {
  const std::unique_ptr<char, decltype(&std::free)> target(::realpath(path.c_str(), nullptr), &std::free);
  return target ? std::string(target.get()) : path;
}

std::string beside(const std::string& path) {
  static std::atomic<unsigned> counter{0};  // counts names only, so that no result depends on it
  const std::filesystem::path full(path);
  const std::string name = "." + full.stem().string() + "." + std::to_string(::getpid()) + "-" +
                           std::to_string(counter++) + full.extension().string();
  return (full.parent_path() / name).string();
}

bool renamed(const std::string& from, const std::string& to, unsigned flags) {
  return ::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), flags) == 0;
}

/// Recognises a file system, or a kernel, that can do nothing but rename.
bool is_unknown_flag(int error) { return error == EINVAL || error == ENOSYS || error == EOPNOTSUPP; }

std::string create_beside(const std::string& path) {
  while (true) {
    std::string name = beside(path);
    const Descriptor file(::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (file.ok()) return name;
    if (errno != EEXIST) fail(path, "cannot be written", errno);
  }
}

void flush_to_disk(const std::string& file, const std::string& shown) {
  Descriptor descriptor(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (!descriptor.ok()) fail(shown, "cannot be written", errno);
  if (::fsync(descriptor.get()) != 0 && errno != EINVAL && errno != EROFS) fail(shown, "cannot be written", errno);
  if (::close(descriptor.release()) != 0) fail(shown, "cannot be written", errno);
}

}  // namespace

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)) {
  struct stat status {};
  if (::stat(path_.c_str(), &status) == 0) {
    if (S_ISDIR(status.st_mode)) throw OutputError(path_ + ": is a directory");
    if (!S_ISREG(status.st_mode)) {  // a device or a pipe is written to, never replaced
      temporary_path_ = path_;
      return;
    }
  }
  path_ = resolved(path_);
  temporary_path_ = create_beside(path_);
}

AtomicFile::~AtomicFile() {
  const bool is_temporary_left = state_ == State::kPending || state_ == State::kReplaced;
  if (is_temporary_left && temporary_path_ != path_) ::unlink(temporary_path_.c_str());
}

void AtomicFile::commit(IfExists rule) {
  if (temporary_path_ == path_) {
    state_ = State::kSettled;
    return;
  }
  flush_to_disk(temporary_path_, path_);
  if (rule == IfExists::kFail) {
    create();
  } else {
    replace();
  }
  const std::string folder = std::filesystem::path(path_).parent_path().string();
  flush_to_disk(folder.empty() ? "." : folder, path_);  // so that the new name survives a power cut
}

void AtomicFile::replace() {
  if (renamed(temporary_path_, path_, RENAME_EXCHANGE)) {
    state_ = State::kReplaced;
    return;
  }
  const bool is_new = errno == ENOENT;
  if (!is_new && !is_unknown_flag(errno)) fail(path_, "cannot be written", errno);
  if (::rename(temporary_path_.c_str(), path_.c_str()) != 0) fail(path_, "cannot be written", errno);
  state_ = is_new ? State::kNew : State::kSettled;
}

void AtomicFile::create() {
  bool is_done = renamed(temporary_path_, path_, RENAME_NOREPLACE);
  if (!is_done && is_unknown_flag(errno)) {
    // A hard link is refused as well when its name is taken.
    is_done = ::link(temporary_path_.c_str(), path_.c_str()) == 0;
    if (is_done) ::unlink(temporary_path_.c_str());
    // Some file systems have no hard links either, so that the name can only be checked first.
    if (!is_done && errno != EEXIST) {
      const bool is_taken = ::access(path_.c_str(), F_OK) == 0;
      is_done = !is_taken && std::rename(temporary_path_.c_str(), path_.c_str()) == 0;
      if (is_taken) errno = EEXIST;
    }
  }
  if (!is_done && errno == EEXIST) {
    throw OutputError("'" + path_ + "' has been made by another run meanwhile; --force replaces it");
  }
  if (!is_done) fail(path_, "cannot be written", errno);
  state_ = State::kNew;
}

void AtomicFile::roll_back() {
  if (state_ == State::kNew) ::unlink(path_.c_str());
  if (state_ == State::kReplaced) std::rename(temporary_path_.c_str(), path_.c_str());
  if (state_ != State::kPending) state_ = State::kSettled;
}

void AtomicFile::settle() {
  if (state_ == State::kReplaced) ::unlink(temporary_path_.c_str());
  if (state_ != State::kPending) state_ = State::kSettled;
}

void write_file(const std::string& path, const std::string& content) {
  AtomicFile file(path);
  Descriptor descriptor(::open(file.temporary_path().c_str(), O_WRONLY | O_CLOEXEC));
  if (!descriptor.ok()) fail(path, "cannot be written", errno);
  std::size_t done = 0;
  while (done < content.size()) {
    const ssize_t count = ::write(descriptor.get(), content.data() + done, content.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(path, "cannot be written", errno);
    done += static_cast<std::size_t>(count);
  }
  if (::close(descriptor.release()) != 0) fail(path, "cannot be written", errno);
  file.commit();
}

}  // namespace shapemap
