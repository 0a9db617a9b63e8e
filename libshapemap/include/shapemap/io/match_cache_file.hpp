// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <unordered_map>

#include "shapemap/mapper/mapper_options.hpp"
#include "shapemap/matching/match_cache.hpp"
#include "shapemap/scan/scan.hpp"

/// Alignments in a file, so that what a run has aligned survives its end, however sudden; docs/formats.md has the
/// bytes.
namespace shapemap {

enum class StateOpening {
  kCreate,   ///< there must be no such file
  kReplace,  ///< whatever is there is lost
  kResume,   ///< there must be one, of the same log, and made with the same options as far as they matter
};

/// Each alignment is handed to the system as soon as it is made, which outlives the process, and is on the disk, which
/// outlives a power cut, about a second later. Memory holds where each alignment lies (some 50 bytes), not what it is.
class MatchCacheFile : public MatchCache {
 public:
  /// `log` has the positions that are looked at, and only those. The options that matter are those of how a position is
  /// seen and how two are aligned: with others, a file may be resumed. Throws InputError for a file that cannot be
  /// resumed, which stays as it is; OutputError for one that cannot be written or that another run has open.
  MatchCacheFile(std::string path, StateOpening opening, const Log& log, const MappingOptions& options);
  ~MatchCacheFile() override;
  MatchCacheFile(const MatchCacheFile&) = delete;
  MatchCacheFile& operator=(const MatchCacheFile&) = delete;

  std::optional<std::vector<MatchCandidate>> find(const MatchKey& key) override;
  /// Throws OutputError when it cannot be written; what is in the file by then can be resumed.
  void keep(const MatchKey& key, const std::vector<MatchCandidate>& candidates) override;

  std::size_t num_resumed() const { return num_resumed_; }  ///< alignments that the file had when it was opened
  const std::string& warning() const { return warning_; }   ///< what was wrong with its end; empty: nothing

 private:
  void open(StateOpening opening);
  void begin(const std::string& header, bool is_new);
  void resume(const std::string& header);
  void index_records(std::uint64_t first);
  void append(const std::string& bytes);

  std::string path_;
  std::uint64_t num_scans_;
  int descriptor_ = -1;
  std::size_t num_resumed_ = 0;
  std::string warning_;

  std::mutex mutex_;  ///< guards what follows, and the end of the file
  std::unordered_map<std::uint64_t, std::uint64_t> record_at_;
  std::uint64_t end_ = 0;
  std::chrono::steady_clock::time_point last_sync_;
};

}  // namespace shapemap
