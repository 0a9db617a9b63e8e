// SPDX-License-Identifier: GPL-3.0-or-later
#include "match_cache_record.hpp"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace shapemap {
namespace {

constexpr std::size_t kWordBytes = 8;
constexpr std::size_t kKeyBytes = 3 * kWordBytes;
constexpr std::size_t kCandidateBytes = 26 * kWordBytes;
constexpr std::size_t kMostCandidates = 1000;  // far more than the options allow
constexpr std::size_t kMostBytes = kKeyBytes + kMostCandidates * kCandidateBytes;

// These bounds of a match are far above anything that a search gives, so that only damage is kept out.
constexpr double kMostDistance_m = 1e4;
constexpr double kMostScore = 1e6;
constexpr double kMostWeight = 1e9;
constexpr std::uint64_t kMostPartners = 10'000'000;

void append_word(std::string& bytes, std::uint64_t value) {
  for (unsigned shift = 0; shift < 64; shift += 8) bytes.push_back(static_cast<char>((value >> shift) & 0xFFU));
}

std::uint64_t word_at(std::string_view bytes, std::size_t offset) {
  std::uint64_t value = 0;
  for (unsigned i = 0; i < kWordBytes; ++i) {
    value |= std::uint64_t{static_cast<unsigned char>(bytes[offset + i])} << (8 * i);
  }
  return value;
}

/// Calls `visit` for each number of a candidate, in the order of the file.
template <class Candidate, class Visit>
void visit_numbers(Candidate& h, Visit&& visit) {
  for (auto* pose : {&h.ref_from_query, &h.fit.ref_from_query}) {
    visit(pose->x_m);
    visit(pose->y_m);
    visit(pose->theta_rad);
  }
  visit(h.score);
  auto& v = h.visibility;
  for (auto* share : {&v.agree, &v.crossed, &v.hidden, &v.unclear, &v.outside, &v.cross_agree, &v.cross_total}) {
    visit(*share);
  }
  for (Eigen::Index i = 0; i < 9; ++i) visit(h.fit.information(i / 3, i % 3));
  visit(h.fit.rms_m);
  visit(h.fit.lever_m);
}

void append_candidate(std::string& bytes, const MatchCandidate& candidate) {
  visit_numbers(candidate, [&](double number) {
    std::uint64_t word = 0;
    std::memcpy(&word, &number, sizeof word);
    append_word(bytes, word);
  });
  append_word(bytes, static_cast<std::uint64_t>(candidate.fit.partners));
}

bool is_plausible(const Pose2& pose) {
  return std::abs(pose.x_m) <= kMostDistance_m && std::abs(pose.y_m) <= kMostDistance_m &&
         std::abs(pose.theta_rad) <= 2.0 * 2.0 * kPi;
}

/// A partner has an information of at most 1 about the place, and of its squared distance about the heading.
bool is_plausible(const LineFit& fit) {
  const bool are_lengths =
      fit.rms_m >= 0.0 && fit.rms_m <= kMostDistance_m && fit.lever_m >= 0.0 && fit.lever_m <= kMostDistance_m;
  constexpr int kFew = 3;  // so few partners have no lever
  const double lever_m = fit.partners < kFew ? kMostDistance_m : std::max(fit.lever_m, 0.1);
  const Eigen::Vector3d reach(1.0, 1.0, lever_m);
  const Eigen::Matrix3d most = 1.001 * (fit.partners + 1.0) * reach * reach.transpose();
  return are_lengths && (fit.information.array().abs() <= most.array()).all();
}

/// Rejects impossible candidates, since a checksum detects damage, not who wrote the record. NaN is rejected too.
bool is_plausible(const MatchCandidate& h) {
  const Visibility& v = h.visibility;
  for (const double weight : {v.agree, v.crossed, v.hidden, v.unclear, v.outside, v.cross_agree, v.cross_total}) {
    if (!(weight >= 0.0 && weight <= kMostWeight)) return false;
  }
  return is_plausible(h.ref_from_query) && is_plausible(h.fit.ref_from_query) && is_plausible(h.fit) &&
         std::abs(h.score) <= kMostScore;
}

std::optional<MatchCandidate> candidate_at(std::string_view bytes, std::size_t offset) {
  MatchCandidate candidate;
  visit_numbers(candidate, [&](double& number) {
    const std::uint64_t word = word_at(bytes, offset);
    std::memcpy(&number, &word, sizeof number);
    offset += kWordBytes;
  });
  const std::uint64_t partners = word_at(bytes, offset);
  if (partners > kMostPartners) return std::nullopt;
  candidate.fit.partners = static_cast<int>(partners);
  if (!is_plausible(candidate)) return std::nullopt;
  return candidate;
}

}  // namespace

void append_u32(std::string& bytes, std::uint32_t value) {
  for (unsigned shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<char>((value >> shift) & 0xFFU));
}

std::uint32_t u32_at(std::string_view bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (unsigned i = 0; i < 4; ++i) {
    value |= std::uint32_t{static_cast<unsigned char>(bytes[offset + i])} << (8 * i);
  }
  return value;
}

std::uint32_t checksum_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<z_size_t>(bytes.size())));
}

std::string record_bytes(const MatchKey& key, const std::vector<MatchCandidate>& candidates) {
  std::string body;
  body.reserve(kKeyBytes + kCandidateBytes * candidates.size());
  append_word(body, key.reference);
  append_word(body, key.query);
  append_word(body, static_cast<std::uint64_t>(key.search));
  for (const MatchCandidate& candidate : candidates) append_candidate(body, candidate);
  std::string bytes;
  bytes.reserve(kRecordHeadBytes + body.size());
  append_u32(bytes, static_cast<std::uint32_t>(body.size()));
  append_u32(bytes, checksum_of(body));
  return bytes += body;
}

std::optional<RecordHead> record_head(std::string_view bytes) {
  const RecordHead head{u32_at(bytes, 0), u32_at(bytes, 4)};
  if (head.num_bytes < kKeyBytes || head.num_bytes > kMostBytes) return std::nullopt;
  if ((head.num_bytes - kKeyBytes) % kCandidateBytes != 0) return std::nullopt;
  return head;
}

std::optional<MatchRecord> match_record(const RecordHead& head, std::string_view body) {
  if (body.size() != head.num_bytes || checksum_of(body) != head.checksum) return std::nullopt;
  const std::uint64_t search = word_at(body, 2 * kWordBytes);
  if (search > static_cast<std::uint64_t>(SearchKind::kLoop)) return std::nullopt;
  MatchRecord record;
  record.key = {word_at(body, 0), word_at(body, kWordBytes), static_cast<SearchKind>(search)};
  for (std::size_t at = kKeyBytes; at < body.size(); at += kCandidateBytes) {
    std::optional<MatchCandidate> candidate = candidate_at(body, at);
    if (!candidate) return std::nullopt;
    record.candidates.push_back(*std::move(candidate));
  }
  return record;
}

}  // namespace shapemap
