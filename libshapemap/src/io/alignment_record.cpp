// SPDX-License-Identifier: GPL-3.0-or-later
#include "alignment_record.hpp"

#include <zlib.h>

#include <cstring>

namespace shapemap {
namespace {

constexpr std::size_t kWordBytes = 8;
constexpr std::size_t kKeyBytes = 3 * kWordBytes;
constexpr std::size_t kHypothesisBytes = 26 * kWordBytes;
constexpr std::size_t kMostBytes = std::size_t{1} << 24U;  // far more than the options allow

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

/// Calls `visit` for each number of a hypothesis, in the order of the file.
template <class Hypothesis, class Visit>
void visit_numbers(Hypothesis& h, Visit&& visit) {
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

void append_hypothesis(std::string& bytes, const PoseHypothesis& hypothesis) {
  visit_numbers(hypothesis, [&](double number) {
    std::uint64_t word = 0;
    std::memcpy(&word, &number, sizeof word);
    append_word(bytes, word);
  });
  append_word(bytes, static_cast<std::uint64_t>(hypothesis.fit.partners));
}

PoseHypothesis hypothesis_at(std::string_view bytes, std::size_t offset) {
  PoseHypothesis hypothesis;
  visit_numbers(hypothesis, [&](double& number) {
    const std::uint64_t word = word_at(bytes, offset);
    std::memcpy(&number, &word, sizeof number);
    offset += kWordBytes;
  });
  hypothesis.fit.partners = static_cast<int>(word_at(bytes, offset));
  return hypothesis;
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

std::string record_bytes(const AlignmentKey& key, const std::vector<PoseHypothesis>& hypotheses) {
  std::string body;
  body.reserve(kKeyBytes + kHypothesisBytes * hypotheses.size());
  append_word(body, key.reference);
  append_word(body, key.query);
  append_word(body, static_cast<std::uint64_t>(key.search));
  for (const PoseHypothesis& hypothesis : hypotheses) append_hypothesis(body, hypothesis);
  std::string bytes;
  bytes.reserve(kRecordHeadBytes + body.size());
  append_u32(bytes, static_cast<std::uint32_t>(body.size()));
  append_u32(bytes, checksum_of(body));
  return bytes += body;
}

std::optional<RecordHead> record_head(std::string_view bytes) {
  const RecordHead head{u32_at(bytes, 0), u32_at(bytes, 4)};
  if (head.num_bytes < kKeyBytes || head.num_bytes > kMostBytes) return std::nullopt;
  if ((head.num_bytes - kKeyBytes) % kHypothesisBytes != 0) return std::nullopt;
  return head;
}

std::optional<AlignmentRecord> alignment_record(const RecordHead& head, std::string_view body) {
  if (body.size() != head.num_bytes || checksum_of(body) != head.checksum) return std::nullopt;
  const std::uint64_t search = word_at(body, 2 * kWordBytes);
  if (search > static_cast<std::uint64_t>(SearchKind::kLoop)) return std::nullopt;
  AlignmentRecord record;
  record.key = {word_at(body, 0), word_at(body, kWordBytes), static_cast<SearchKind>(search)};
  for (std::size_t at = kKeyBytes; at < body.size(); at += kHypothesisBytes) {
    record.hypotheses.push_back(hypothesis_at(body, at));
  }
  return record;
}

}  // namespace shapemap
