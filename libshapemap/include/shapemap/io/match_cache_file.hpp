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

/// Matches are kept in a file, so that they survive the end of a run, however sudden; docs/formats.md describes its
/// bytes.
namespace shapemap {

enum class StateOpening {
  kCreate,   ///< no such file may exist
  kReplace,  ///< an existing file is lost
  kResume,   ///< the file must exist, be of the same log, and be made with the same options as far as they matter
};

/// Each match is handed to the system as soon as it is made, which outlives the process, and is on the disk, which
/// outlives a power cut, about a second later. Memory holds where each match lies (some 50 bytes), not the match.
class MatchCacheFile : public MatchCache {
 public:
  /// `log` has the selected scans only. The options that matter are those of how a scan is seen and how two are
  /// matched; a file may be resumed with others changed. Throws InputError for a file that cannot be resumed, which
  /// stays as it is, and OutputError for one that cannot be written or that another run has open.
  MatchCacheFile(std::string path, StateOpening opening, const Log& log, const MappingOptions& options);
  ~MatchCacheFile() override;
  MatchCacheFile(const MatchCacheFile&) = delete;
  MatchCacheFile& operator=(const MatchCacheFile&) = delete;

  std::optional<std::vector<MatchCandidate>> find(const MatchKey& key) override;
  /// Throws OutputError when the match cannot be written; the file can be resumed up to it.
  void keep(const MatchKey& key, const std::vector<MatchCandidate>& candidates) override;

  std::size_t num_resumed() const { return num_resumed_; }  ///< matches in the file when it was opened
  const std::string& warning() const { return warning_; }   ///< damage at the end of the file; empty: none

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

  std::mutex mutex_;  ///< guards the following members, and the end of the file
  std::unordered_map<std::uint64_t, std::uint64_t> record_at_;
  std::uint64_t end_ = 0;
  std::chrono::steady_clock::time_point last_sync_;
};

}  // namespace shapemap
