// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "shapemap/matching/match_cache.hpp"

/// A match in a state file is its size, its checksum, and words of eight bytes; all are little endian.
namespace shapemap {

inline constexpr std::size_t kRecordHeadBytes = 8;

struct RecordHead {
  std::uint32_t num_bytes = 0;  ///< size of the body that follows
  std::uint32_t checksum = 0;   ///< checksum of the body
};

struct MatchRecord {
  MatchKey key;
  std::vector<MatchCandidate> candidates;
};

void append_u32(std::string& bytes, std::uint32_t value);
std::uint32_t u32_at(std::string_view bytes, std::size_t offset);
std::uint32_t checksum_of(std::string_view bytes);

/// Returns head and body of a record.
std::string record_bytes(const MatchKey& key, const std::vector<MatchCandidate>& candidates);

/// Returns nothing for a size that no body has; `bytes` are kRecordHeadBytes long.
std::optional<RecordHead> record_head(std::string_view bytes);

/// Returns nothing for a damaged body.
std::optional<MatchRecord> match_record(const RecordHead& head, std::string_view body);

}  // namespace shapemap
