// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/match/similarity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace shapemap {
namespace {

using Word = BitMatrix::Word;

/// Levels of a stored bin, 0 to kHistogramScale, and one more that none reaches.
constexpr std::size_t kLevels = static_cast<std::size_t>(kHistogramScale) + 2;

/// Words that are worked on together, so that compilers make vector code of it.
constexpr std::size_t kBlock = 2;

/// Counters for 64 * kBlock target points, one bit of each to a word, that stay at "too many" once they overflow.
/// They count to 2 ^ kPlanes - 1.
template <std::size_t kPlanes>
class BitCounters {
 public:
  /// Adds 1 wherever a bit of `ones` is set.
  void add(std::array<Word, kBlock> ones) {
    for (std::size_t plane = 0; plane < kPlanes; ++plane) {
      for (std::size_t w = 0; w < kBlock; ++w) {
        const Word carry = planes_[plane][w] & ones[w];
        planes_[plane][w] ^= ones[w];
        ones[w] = carry;
      }
    }
    for (std::size_t w = 0; w < kBlock; ++w) overflow_[w] |= ones[w];
  }

  /// The points whose count is `highest` or less.
  Word not_above(unsigned highest, std::size_t w) const {
    Word below = 0;
    Word equal = ~Word{0};
    for (std::size_t plane = kPlanes; plane-- > 0;) {
      const Word limit = ((highest >> plane) & 1U) ? ~Word{0} : Word{0};
      below |= equal & limit & ~planes_[plane][w];
      equal &= ~(limit ^ planes_[plane][w]);
    }
    return (below | equal) & ~overflow_[w];
  }

 private:
  std::array<std::array<Word, kBlock>, kPlanes> planes_{};
  std::array<Word, kBlock> overflow_{};
};

/// For each bin of one query point: which target points are too high, and which are high enough.
struct BinRows {
  std::array<const Word*, kHistogramBins> too_high{};
  std::array<const Word*, kHistogramBins> high_enough{};
};

/// Words [first, last) of `similar`: the points of which `highest` bins or fewer differ.
template <std::size_t kPlanes>
void few_differences(const BinRows& rows, unsigned highest, std::size_t first, std::size_t last, Word* similar) {
  for (std::size_t block = first / kBlock * kBlock; block < last; block += kBlock) {
    BitCounters<kPlanes> differing;
    for (std::size_t bin = 0; bin < kHistogramBins; ++bin) {
      std::array<Word, kBlock> ones;
      for (std::size_t w = 0; w < kBlock; ++w) {
        ones[w] = rows.too_high[bin][block + w] | ~rows.high_enough[bin][block + w];
      }
      differing.add(ones);
    }
    for (std::size_t w = 0; w < kBlock; ++w) similar[block + w] = differing.not_above(highest, w);
  }
}

/// Index of the lowest bit that is set in `word`, which is not 0.
std::size_t lowest_bit(Word word) {
  static_assert(sizeof(Word) == sizeof(unsigned long long));
  return static_cast<std::size_t>(__builtin_ctzll(word));
}

std::vector<std::size_t> by_tangent(const std::vector<double>& tangents_rad) {
  std::vector<std::size_t> order(tangents_rad.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return tangents_rad[a] < tangents_rad[b]; });
  return order;
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
      bin_tolerance_steps_(static_cast<int>(std::floor(options.bin_tolerance * kHistogramScale + 1e-9))),
      order_(by_tangent(target.tangents_rad)),
      at_least_(kHistogramBins * kLevels, (target.size() + kBlock * BitMatrix::kWordBits - 1) /
                                              (kBlock * BitMatrix::kWordBits) * kBlock * BitMatrix::kWordBits) {
  tangents_rad_.reserve(order_.size());
  for (const std::size_t point : order_) tangents_rad_.push_back(target.tangents_rad[point]);
  for (std::size_t bin = 0; bin < kHistogramBins; ++bin) {
    for (std::size_t k = 0; k < order_.size(); ++k) {
      at_least_.set(bin * kLevels + target.histograms[order_[k]].bins[bin], k);
    }
    for (std::size_t level = kLevels - 1; level-- > 0;) {
      Word* here = at_least_.row(bin * kLevels + level);
      const Word* above = here + at_least_.words_per_row();
      for (std::size_t w = 0; w < at_least_.words_per_row(); ++w) here[w] |= above[w];
    }
  }
}

void SimilarityIndex::match_words(const AngularHistogram& query, std::size_t first, std::size_t last,
                                  Words& similar) const {
  // A target bin differs when it is above the query's bin and the tolerance, or not at least the bin less the
  // tolerance.
  BinRows rows;
  for (std::size_t bin = 0; bin < kHistogramBins; ++bin) {
    const int above = std::min(query.bins[bin] + bin_tolerance_steps_ + 1, static_cast<int>(kLevels) - 1);
    const int least = std::max(query.bins[bin] - bin_tolerance_steps_, 0);
    rows.too_high[bin] = at_least_.row(bin * kLevels + static_cast<std::size_t>(above));
    rows.high_enough[bin] = at_least_.row(bin * kLevels + static_cast<std::size_t>(least));
  }
  const auto highest = static_cast<unsigned>(options_.max_differing_bins);
  if (highest < 4) {  // two planes hold the paper's limit
    few_differences<2>(rows, highest, first, last, similar.data());
  } else {
    few_differences<6>(rows, highest, first, last, similar.data());
  }
}

void SimilarityIndex::match_range(const AngularHistogram& query, double from_rad, double to_rad, Words& similar,
                                  Word* row) const {
  const auto begin = static_cast<std::size_t>(std::lower_bound(tangents_rad_.begin(), tangents_rad_.end(), from_rad) -
                                              tangents_rad_.begin());
  const auto end = static_cast<std::size_t>(std::upper_bound(tangents_rad_.begin(), tangents_rad_.end(), to_rad) -
                                            tangents_rad_.begin());
  if (begin >= end) return;
  const std::size_t first_word = begin / BitMatrix::kWordBits;
  const std::size_t last_word = (end - 1) / BitMatrix::kWordBits;
  match_words(query, first_word, last_word + 1, similar);
  similar[first_word] &= ~Word{0} << (begin % BitMatrix::kWordBits);
  similar[last_word] &= ~Word{0} >> (BitMatrix::kWordBits - 1 - (end - 1) % BitMatrix::kWordBits);
  for (std::size_t w = first_word; w <= last_word; ++w) {
    for (Word rest = similar[w]; rest != 0; rest &= rest - 1) {
      const std::size_t point = order_[w * BitMatrix::kWordBits + lowest_bit(rest)];
      row[point / BitMatrix::kWordBits] |= Word{1} << (point % BitMatrix::kWordBits);
    }
  }
}

BitMatrix SimilarityIndex::matches(const ScanFeatures& query) const {
  BitMatrix bits(query.size(), order_.size());
  Words similar(at_least_.words_per_row());
  for (std::size_t i = 0; i < query.size(); ++i) {
    const AngularHistogram& wanted = query.histograms[i];
    const double tangent_rad = query.tangents_rad[i];
    const double from_rad = tangent_rad - options_.tangent_tolerance_rad;
    const double to_rad = tangent_rad + options_.tangent_tolerance_rad;
    match_range(wanted, from_rad, to_rad, similar, bits.row(i));
    // Minus and plus half a turn are one direction: at the seam itself, both ends are looked up.
    if (from_rad <= -kPi) match_range(wanted, from_rad + 2 * kPi, kPi, similar, bits.row(i));
    if (to_rad >= kPi) match_range(wanted, -kPi, to_rad - 2 * kPi, similar, bits.row(i));
  }
  return bits;
}

}  // namespace shapemap
