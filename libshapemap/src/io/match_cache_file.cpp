// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/io/match_cache_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "match_cache_header.hpp"
#include "match_cache_record.hpp"
#include "shapemap/core/errors.hpp"

namespace shapemap {
namespace {

/// A power cut costs the work of about so long; syncing each match would take longer than making it.
constexpr std::chrono::seconds kSyncEvery{1};

constexpr std::uint64_t kMostScans = std::uint64_t{1} << 31U;

[[noreturn]] void fail(const std::string& path, const std::string& what) {
  throw OutputError("cannot write '" + path + "': " + what);
}

/// Packs a key into one number, since scans are fewer than kMostScans.
std::uint64_t packed(const MatchKey& key) {
  return std::uint64_t{key.reference} << 33U | std::uint64_t{key.query} << 2U | static_cast<std::uint64_t>(key.search);
}

/// Reads up to `count` bytes, fewer at the end of the file.
std::string read_at(int descriptor, std::uint64_t offset, std::size_t count, const std::string& path) {
  std::string bytes(count, '\0');
  std::size_t done = 0;
  while (done < count) {
    const ssize_t got = ::pread(descriptor, bytes.data() + done, count - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw InputError("cannot read '" + path + "': " + std::strerror(errno));
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  bytes.resize(done);
  return bytes;
}

/// Reads the whole record that begins at `offset`, if there is one.
std::optional<MatchRecord> read_record(int descriptor, std::uint64_t offset, const std::string& path) {
  const std::string head_bytes = read_at(descriptor, offset, kRecordHeadBytes, path);
  if (head_bytes.size() < kRecordHeadBytes) return std::nullopt;
  const std::optional<RecordHead> head = record_head(head_bytes);
  if (!head) return std::nullopt;
  return match_record(*head, read_at(descriptor, offset + kRecordHeadBytes, head->num_bytes, path));
}

std::uint64_t record_size(const MatchRecord& record) { return record_bytes(record.key, record.candidates).size(); }

bool is_synced(int descriptor) { return ::fdatasync(descriptor) == 0 || errno == EINVAL || errno == EROFS; }

/// Syncs the folder, so that the name of a new file survives a power cut, too.
void sync_folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;  // a folder may be writable and not readable
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

MatchCacheFile::MatchCacheFile(std::string path, StateOpening opening, const Log& log, const MappingOptions& options)
    : path_(std::move(path)), num_scans_(log.scans.size()) {
  if (num_scans_ >= kMostScans) fail(path_, "the log has too many positions");
  const std::string header = state_header(log, options);
  try {
    open(opening);
    if (opening == StateOpening::kResume) {
      resume(header);
    } else {
      begin(header, opening == StateOpening::kCreate);
    }
  } catch (...) {
    if (descriptor_ >= 0) ::close(descriptor_);
    throw;
  }
  last_sync_ = std::chrono::steady_clock::now();
}

MatchCacheFile::~MatchCacheFile() {
  ::fdatasync(descriptor_);
  ::close(descriptor_);
}

void MatchCacheFile::open(StateOpening opening) {
  struct stat status {};
  if (::stat(path_.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) fail(path_, "it is not a file");
  int flags = O_RDWR | O_CLOEXEC;
  if (opening != StateOpening::kResume) flags |= O_CREAT;
  if (opening == StateOpening::kCreate) flags |= O_EXCL;
  descriptor_ = ::open(path_.c_str(), flags, 0666);
  if (descriptor_ < 0) {
    if (errno == ENOENT && opening == StateOpening::kResume) {
      throw InputError("there is no state '" + path_ + "' to resume");
    }
    fail(path_, std::strerror(errno));
  }
  // A file system without locks is no reason not to run.
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) fail(path_, "another run has it open");
}

void MatchCacheFile::begin(const std::string& header, bool is_new) {
  try {
    if (::ftruncate(descriptor_, 0) != 0) fail(path_, std::strerror(errno));
    append(header);
    if (!is_synced(descriptor_)) fail(path_, std::strerror(errno));
  } catch (const OutputError&) {
    if (is_new) ::unlink(path_.c_str());
    throw;
  }
  sync_folder_of(path_);
}

void MatchCacheFile::resume(const std::string& header) {
  const std::string found = read_at(descriptor_, 0, kMostHeaderBytes, path_);
  if (found.size() < header.size() && header.compare(0, found.size(), found) == 0) {
    warning_ = "'" + path_ + "' ends after " + std::to_string(found.size()) + " bytes, before its first alignment";
    return begin(header, false);
  }
  const std::string why = header_difference(found, header);
  if (!why.empty()) {
    throw InputError("cannot resume '" + path_ + "': it " + why + "; --force without --resume begins anew");
  }
  index_records(header.size());
}

void MatchCacheFile::index_records(std::uint64_t first) {
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) throw InputError("cannot read '" + path_ + "': " + std::strerror(errno));
  const auto size = static_cast<std::uint64_t>(status.st_size);
  end_ = first;
  while (end_ < size) {
    const std::optional<MatchRecord> record = read_record(descriptor_, end_, path_);
    if (!record || record->key.reference >= num_scans_ || record->key.query >= num_scans_) break;
    record_at_.emplace(packed(record->key), end_);
    end_ += record_size(*record);
  }
  num_resumed_ = record_at_.size();
  if (end_ == size) return;
  if (::ftruncate(descriptor_, static_cast<off_t>(end_)) != 0) fail(path_, std::strerror(errno));
  warning_ = "'" + path_ + "' is damaged or cut off at byte " + std::to_string(end_) + " of " + std::to_string(size) +
             ": the " + std::to_string(num_resumed_) + " alignments before it are used, the rest is made again";
}

std::optional<std::vector<MatchCandidate>> MatchCacheFile::find(const MatchKey& key) {
  std::uint64_t offset = 0;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = record_at_.find(packed(key));
    if (found == record_at_.end()) return std::nullopt;
    offset = found->second;
  }
  std::optional<MatchRecord> record = read_record(descriptor_, offset, path_);
  // the file was changed meanwhile, so that the match is made again
  if (!record || packed(record->key) != packed(key)) return std::nullopt;
  return std::move(record->candidates);
}

void MatchCacheFile::keep(const MatchKey& key, const std::vector<MatchCandidate>& candidates) {
  const std::string bytes = record_bytes(key, candidates);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (record_at_.count(packed(key)) > 0) return;
    const std::uint64_t offset = end_;
    append(bytes);
    record_at_.emplace(packed(key), offset);
    const auto now = std::chrono::steady_clock::now();
    if (now - last_sync_ < kSyncEvery) return;
    last_sync_ = now;
  }
  if (!is_synced(descriptor_)) fail(path_, std::strerror(errno));
}

/// A write that fails is taken back whole.
void MatchCacheFile::append(const std::string& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count =
        ::pwrite(descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(end_ + done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      const int error = errno;
      [[maybe_unused]] const int ignored = ::ftruncate(descriptor_, static_cast<off_t>(end_));
      fail(path_, std::strerror(error));
    }
    done += static_cast<std::size_t>(count);
  }
  end_ += bytes.size();
}

}  // namespace shapemap
