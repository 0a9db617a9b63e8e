// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/paper/similarity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace shapemap {
namespace {

using Word = BitMatrix::Word;

/// A stored bin has the levels 0 to kHistogramScale; there is one more, that none reaches.
constexpr std::size_t kLevels = static_cast<std::size_t>(kHistogramScale) + 2;

/// So many words are worked on together, so that compilers make vector code of it.
constexpr std::size_t kBlock = 2;
constexpr std::size_t kBlockPoints = kBlock * BitMatrix::kWordBits;
constexpr std::size_t kWordsPerBlock = kHistogramBins * kLevels * kBlock;

/// Counts for 64 * kBlock target points at once, one bit of each counter to a word. The counters go to
/// 2 ^ kPlanes - 1 and stay at "too many" once they overflow.
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

/// Returns the index of the lowest bit that is set in `word`, which is not 0.
std::size_t lowest_bit(Word word) {
  static_assert(sizeof(Word) == sizeof(unsigned long long));
  return static_cast<std::size_t>(__builtin_ctzll(word));
}

using BlockWords = std::array<Word, kBlock>;

/// Some of the bins of a histogram, by their numbers.
struct BinList {
  std::array<std::uint8_t, kHistogramBins> bins{};
  std::size_t size = 0;
};

/// Returns the bins for which `wanted` is true, without a branch, since none could be foreseen.
template <class Wanted>
BinList bins_where(Wanted&& wanted) {
  BinList list;
  std::size_t size = 0;  // in a register: a byte that is written could be any member
  for (std::size_t bin = 0; bin < kHistogramBins; ++bin) {
    list.bins[size] = static_cast<std::uint8_t>(bin);
    size += static_cast<std::size_t>(wanted(bin));
  }
  list.size = size;
  return list;
}

/// What a target point must be like to be similar to a query point: its bins are below `too_high`, and those of them
/// that are `high` in the query are not below `enough`. The others cannot be too low.
struct WantedBins {
  std::array<std::uint8_t, kStoredBins> too_high{};
  std::array<std::uint8_t, kStoredBins> enough{};
  BinList high;

  WantedBins(const AngularHistogram& histogram, int tolerance_steps) {
    constexpr int kNone = static_cast<int>(kLevels) - 1;
    for (std::size_t bin = 0; bin < kStoredBins; ++bin) {
      too_high[bin] = static_cast<std::uint8_t>(std::min(histogram.bins[bin] + tolerance_steps + 1, kNone));
    }
    for (std::size_t bin = 0; bin < kStoredBins; ++bin) {
      enough[bin] = static_cast<std::uint8_t>(std::max(histogram.bins[bin] - tolerance_steps, 0));
    }
    high = bins_where([&](std::size_t bin) { return enough[bin] > 0; });
  }
};

/// Returns the points of a block of which `highest` bins or fewer differ. `at_least` has the block's words for each bin
/// and level. A bin can be too high only if it is among `peaks`: neighbours in the order of tangents have their few
/// peaks in the same bins, so that most bins need no look.
template <std::size_t kPlanes>
BlockWords few_differences(const WantedBins& wanted, const Word* at_least, const BinList& peaks, unsigned highest) {
  const auto words = [&](std::size_t bin, std::size_t level) { return at_least + (bin * kLevels + level) * kBlock; };
  BitCounters<kPlanes> differing;
  BlockWords ones;
  for (std::size_t k = 0; k < peaks.size; ++k) {
    const Word* too_high = words(peaks.bins[k], wanted.too_high[peaks.bins[k]]);
    for (std::size_t w = 0; w < kBlock; ++w) ones[w] = too_high[w];
    differing.add(ones);
  }
  for (std::size_t k = 0; k < wanted.high.size; ++k) {  // no bin of a point is both too high and too low
    const Word* enough = words(wanted.high.bins[k], wanted.enough[wanted.high.bins[k]]);
    for (std::size_t w = 0; w < kBlock; ++w) ones[w] = ~enough[w];
    differing.add(ones);
  }
  for (std::size_t w = 0; w < kBlock; ++w) ones[w] = differing.not_above(highest, w);
  return ones;
}

/// Returns a word of which the bits [begin, end) are set.
Word bits_between(std::size_t begin, std::size_t end) {
  return (~Word{0} << begin) & (~Word{0} >> (BitMatrix::kWordBits - end));
}

/// Sets the bit of `order[k]` in `row` for each bit k of `found`. Neighbours in the order are mostly neighbours in the
/// row: their bits are gathered before the row is touched.
void set_bits(Word found, const std::size_t* order, Word* row) {
  std::size_t at = 0;
  Word gathered = 0;
  for (; found != 0; found &= found - 1) {
    const std::size_t point = order[lowest_bit(found)];
    if (point / BitMatrix::kWordBits != at) {
      row[at] |= gathered;
      at = point / BitMatrix::kWordBits;
      gathered = 0;
    }
    gathered |= Word{1} << (point % BitMatrix::kWordBits);
  }
  row[at] |= gathered;
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
      order_(by_tangent(target.tangents_rad)) {
  static_assert(kHistogramBins <= BitMatrix::kWordBits, "a word holds a bit for each bin");
  tangents_rad_.reserve(order_.size());
  for (const std::size_t point : order_) tangents_rad_.push_back(target.tangents_rad[point]);
  const std::size_t num_blocks = (order_.size() + kBlockPoints - 1) / kBlockPoints;
  at_least_.resize(num_blocks * kWordsPerBlock);
  peaks_.resize(num_blocks);
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const AngularHistogram& histogram = target.histograms[order_[k]];
    Word* block = at_least_.data() + k / kBlockPoints * kWordsPerBlock;
    const std::size_t word = k % kBlockPoints / BitMatrix::kWordBits;
    for (std::size_t bin = 0; bin < kHistogramBins; ++bin) {
      block[(bin * kLevels + histogram.bins[bin]) * kBlock + word] |= Word{1} << (k % BitMatrix::kWordBits);
      peaks_[k / kBlockPoints] |= static_cast<Word>(histogram.bins[bin] > bin_tolerance_steps_) << bin;
    }
  }
  for (std::size_t row = 0; row < num_blocks * kHistogramBins; ++row) {
    Word* levels = at_least_.data() + row * kLevels * kBlock;
    for (std::size_t w = (kLevels - 1) * kBlock; w-- > 0;) levels[w] |= levels[w + kBlock];
  }
}

std::vector<SimilarityIndex::Range> SimilarityIndex::ranges(const ScanFeatures& query) const {
  std::vector<Range> found;
  found.reserve(query.size());
  const auto add = [&](std::size_t i, double from_rad, double to_rad) {
    const auto begin = std::lower_bound(tangents_rad_.begin(), tangents_rad_.end(), from_rad);
    const auto end = std::upper_bound(tangents_rad_.begin(), tangents_rad_.end(), to_rad);
    if (begin >= end) return;
    found.push_back({i, static_cast<std::size_t>(begin - tangents_rad_.begin()),
                     static_cast<std::size_t>(end - tangents_rad_.begin())});
  };
  for (std::size_t i = 0; i < query.size(); ++i) {
    const double from_rad = query.tangents_rad[i] - options_.tangent_tolerance_rad;
    const double to_rad = query.tangents_rad[i] + options_.tangent_tolerance_rad;
    add(i, from_rad, to_rad);
    // Minus and plus half a turn are one direction: at the seam itself, both ends are looked up.
    if (from_rad <= -kPi) add(i, from_rad + 2 * kPi, kPi);
    if (to_rad >= kPi) add(i, -kPi, to_rad - 2 * kPi);
  }
  return found;
}

BitMatrix SimilarityIndex::matches(const ScanFeatures& query) const {
  BitMatrix bits(query.size(), order_.size());
  const auto highest = static_cast<unsigned>(options_.max_differing_bins);
  const auto few = highest < 4 ? few_differences<2> : few_differences<6>;  // two planes hold the paper's limit
  const std::vector<Range> wanted = ranges(query);
  std::vector<WantedBins> bins;
  bins.reserve(query.size());
  for (const AngularHistogram& histogram : query.histograms) bins.emplace_back(histogram, bin_tolerance_steps_);
  // Block by block: the words of one block stay in the processor's cache while all query points go over them.
  for (std::size_t block = 0; block < peaks_.size(); ++block) {
    const std::size_t first = block * kBlockPoints;
    const BinList peaks = bins_where([&](std::size_t bin) { return ((peaks_[block] >> bin) & 1U) != 0; });
    for (const Range& range : wanted) {
      if (range.end <= first || range.begin >= first + kBlockPoints) continue;
      const BlockWords similar = few(bins[range.query], at_least_.data() + block * kWordsPerBlock, peaks, highest);
      for (std::size_t w = 0; w < kBlock; ++w) {
        const std::size_t origin = first + w * BitMatrix::kWordBits;
        const std::size_t begin = std::max(range.begin, origin);
        const std::size_t end = std::min(range.end, origin + BitMatrix::kWordBits);
        if (begin >= end) continue;
        set_bits(similar[w] & bits_between(begin - origin, end - origin), order_.data() + origin,
                 bits.row(range.query));
      }
    }
  }
  return bits;
}

}  // namespace shapemap
