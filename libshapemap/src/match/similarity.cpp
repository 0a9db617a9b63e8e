// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/match/similarity.hpp"

#include <algorithm>
#include <cmath>

namespace shapemap {
namespace {

/// The number of bins that are farther apart than `tolerance`. Written so that compilers make vector code of it: 16
/// bytes side by side, unsigned, with a difference that saturates.
int differing_bins(const AngularHistogram& a, const AngularHistogram& b, std::uint8_t tolerance) {
  constexpr std::size_t kLanes = 16;
  std::array<std::uint8_t, kLanes> differing{};
  for (std::size_t block = 0; block < kStoredBins; block += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::uint8_t high = std::max(a.bins[block + lane], b.bins[block + lane]);
      const std::uint8_t low = std::min(a.bins[block + lane], b.bins[block + lane]);
      const auto apart = static_cast<std::uint8_t>(high - low);
      differing[lane] = static_cast<std::uint8_t>(differing[lane] + (apart > tolerance ? 1 : 0));
    }
  }
  int sum = 0;
  for (const std::uint8_t count : differing) sum += count;
  return sum;
}

bool more_bits_than(std::uint64_t bits, int count) {
  for (int k = 0; k < count && bits != 0; ++k) bits &= bits - 1;  // drops the lowest bit that is set
  return bits != 0;
}

}  // namespace

ScanFeatures features_of(const Shape& shape, const NeighbourDirections& directions, double rotation_rad,
                         HistogramNorm norm) {
  ScanFeatures features;
  features.tangents_rad.reserve(shape.size());
  for (const ShapePoint& point : shape.points) {
    features.tangents_rad.push_back(wrap_angle(point.tangent_rad + rotation_rad));
  }
  features.histograms = directions.histograms(rotation_rad, norm);
  return features;
}

SimilarityIndex::SimilarityIndex(const ScanFeatures& target, const SimilarityOptions& options)
    : options_(options),
      bin_tolerance_steps_(static_cast<int>(std::floor(options.bin_tolerance * kHistogramScale + 1e-9))) {
  entries_.reserve(target.size());
  for (std::size_t i = 0; i < target.size(); ++i) {
    entries_.push_back(entry_of(target.tangents_rad[i], target.histograms[i], i));
  }
  std::stable_sort(entries_.begin(), entries_.end(),
                   [](const Entry& a, const Entry& b) { return a.tangent_rad < b.tangent_rad; });
}

SimilarityIndex::Entry SimilarityIndex::entry_of(double tangent_rad, const AngularHistogram& histogram,
                                                 std::size_t point) const {
  Entry entry{tangent_rad, 0, 0, point, histogram};
  for (std::size_t b = 0; b < kHistogramBins; ++b) {
    if (histogram.bins[b] == 0) entry.empty_bins |= std::uint64_t{1} << b;
    if (histogram.bins[b] > bin_tolerance_steps_) entry.full_bins |= std::uint64_t{1} << b;
  }
  return entry;
}

bool SimilarityIndex::similar_histograms(const Entry& a, const Entry& b) const {
  // Most pairs differ in many bins that are empty in one and full in the other: a few instructions rule them out.
  const std::uint64_t surely_differ = (a.empty_bins & b.full_bins) | (a.full_bins & b.empty_bins);
  if (more_bits_than(surely_differ, options_.max_differing_bins)) return false;
  return differing_bins(a.histogram, b.histogram, static_cast<std::uint8_t>(bin_tolerance_steps_)) <=
         options_.max_differing_bins;
}

void SimilarityIndex::match_range(const Entry& query, double from_rad, double to_rad, BitMatrix::Word* row) const {
  auto entry = std::lower_bound(entries_.begin(), entries_.end(), from_rad,
                                [](const Entry& e, double angle_rad) { return e.tangent_rad < angle_rad; });
  for (; entry != entries_.end() && entry->tangent_rad <= to_rad; ++entry) {
    if (!similar_histograms(query, *entry)) continue;
    row[entry->point / BitMatrix::kWordBits] |= BitMatrix::Word{1} << (entry->point % BitMatrix::kWordBits);
  }
}

BitMatrix SimilarityIndex::matches(const ScanFeatures& query) const {
  BitMatrix bits(query.size(), entries_.size());
  for (std::size_t i = 0; i < query.size(); ++i) {
    const Entry wanted = entry_of(query.tangents_rad[i], query.histograms[i], i);
    const double from_rad = wanted.tangent_rad - options_.tangent_tolerance_rad;
    const double to_rad = wanted.tangent_rad + options_.tangent_tolerance_rad;
    match_range(wanted, from_rad, to_rad, bits.row(i));
    // Minus and plus half a turn are one direction: at the seam itself, both ends are looked up.
    if (from_rad <= -kPi) match_range(wanted, from_rad + 2 * kPi, kPi, bits.row(i));
    if (to_rad >= kPi) match_range(wanted, -kPi, to_rad - 2 * kPi, bits.row(i));
  }
  return bits;
}

}  // namespace shapemap
