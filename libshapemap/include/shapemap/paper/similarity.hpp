// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "shapemap/core/options.hpp"
#include "shapemap/shape/angular_histogram.hpp"

/// Paper, sections II-A and II-B: which points of two scans are similar, by tangent directions and angular histograms.
namespace shapemap {

struct SimilarityOptions {
  double tangent_tolerance_rad = 10 * kDegree;
  double bin_tolerance = 0.25;
  int max_differing_bins = 2;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"tangent-tolerance-deg", "similar points have tangents within this angle [deg]", 0, 180, kDegree},
          self.tangent_tolerance_rad);
    visit(Field{"histogram-bin-tolerance", "two bins differ when they are farther apart", 0, 1}, self.bin_tolerance);
    visit(Field{"max-differing-bins", "similar points have at most this many differing bins", 0, 36},
          self.max_differing_bins);
  }
};

/// A matrix of bits, stored in rows of 64-bit words; bits beyond the last column are 0.
class BitMatrix {
 public:
  using Word = std::uint64_t;
  static constexpr std::size_t kWordBits = 64;

  BitMatrix(std::size_t rows, std::size_t columns)
      : rows_(rows), columns_(columns), words_((columns + kWordBits - 1) / kWordBits), bits_(rows * words_, 0) {}

  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }
  std::size_t words_per_row() const { return words_; }
  Word* row(std::size_t r) { return bits_.data() + r * words_; }
  const Word* row(std::size_t r) const { return bits_.data() + r * words_; }
  bool test(std::size_t r, std::size_t c) const { return (row(r)[c / kWordBits] >> (c % kWordBits)) & 1U; }
  void set(std::size_t r, std::size_t c) { row(r)[c / kWordBits] |= Word{1} << (c % kWordBits); }

 private:
  std::size_t rows_;
  std::size_t columns_;
  std::size_t words_;
  std::vector<Word> bits_;
};

/// The tangent directions and angular histograms of a scan at one rotation, point by point.
struct ScanFeatures {
  std::vector<double> tangents_rad;
  std::vector<AngularHistogram> histograms;

  std::size_t size() const { return tangents_rad.size(); }
};

/// Computes the features of `shape` turned by `rotation_rad`; `directions` are those of the same shape, not turned.
ScanFeatures features_of(const Shape& shape, const NeighbourDirections& directions, double rotation_rad,
                         HistogramNorm norm);

/// The features of a target scan, ordered by tangent for quick look-up.
class SimilarityIndex {
 public:
  SimilarityIndex(const ScanFeatures& target, const SimilarityOptions& options);

  /// In the matrix, rows are points of the query and columns points of the target; a set bit says that they are
  /// similar.
  BitMatrix matches(const ScanFeatures& query) const;

 private:
  /// The target points, by position in `order_`, whose tangents are close enough to that of a query point.
  struct Range {
    std::size_t query;
    std::size_t begin;
    std::size_t end;
  };

  std::vector<Range> ranges(const ScanFeatures& query) const;

  SimilarityOptions options_;
  int bin_tolerance_steps_;           ///< in steps of the stored bins
  std::vector<std::size_t> order_;    ///< target points by ascending tangent in [-pi, pi]
  std::vector<double> tangents_rad_;  ///< in that order
  /// Block after block of points in that order; in a block, for each bin and level, the points whose bin is at that
  /// level or above. Differing bins of one query point and many target points are then counted at once, with bits side
  /// by side.
  std::vector<BitMatrix::Word> at_least_;
  std::vector<BitMatrix::Word> peaks_;  ///< per block: a bit for each bin that is above the tolerance in any point
};

}  // namespace shapemap
