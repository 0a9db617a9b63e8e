// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "shapemap/core/options.hpp"
#include "shapemap/shape/shape.hpp"

/// The angular histogram of a point counts the directions to all scan points around it (paper, section II-B).
namespace shapemap {

/// The count of each bin is divided by one of these.
enum class HistogramNorm {
  kMaximum,  ///< the largest bin
  kL2,       ///< the square root of the sum of squares
  kCount,    ///< the number of neighbours
};

template <>
struct EnumNames<HistogramNorm> {
  static constexpr std::array<std::string_view, 3> names{"maximum", "l2", "count"};
};

struct HistogramOptions {
  double radius_m = 0.50;
  HistogramNorm norm = HistogramNorm::kMaximum;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"histogram-radius-m", "shape points this close to a point are in its histogram [m]", 0.05, 10},
          self.radius_m);
    visit(Field{"histogram-norm", "what the bins are divided by"}, self.norm);
  }
};

/// The paper uses this number of bins.
inline constexpr std::size_t kHistogramBins = 36;

/// Bins of a normalised histogram are stored in steps of 1/252, in which the paper's 0.25 and all quarters, thirds and
/// sevenths are exact.
inline constexpr double kHistogramScale = 252.0;

/// Bins after the last one are always 0: they round the size up to whole vector registers.
inline constexpr std::size_t kStoredBins = 48;
struct AngularHistogram {
  std::array<std::uint8_t, kStoredBins> bins{};
};

/// Normalises counts and stores them as bins. All-zero counts give an all-zero histogram.
AngularHistogram normalised(const std::array<int, kHistogramBins>& counts, HistogramNorm norm);

/// The directions from each point of a shape to its neighbours are computed once, and binned anew for each rotation.
class NeighbourDirections {
 public:
  NeighbourDirections(const Shape& shape, double radius_m);

  /// Returns one histogram per point, for the shape turned by `rotation_rad`. Bin b holds directions from b to b + 1
  /// times 10 degrees, counterclockwise from the x axis.
  std::vector<AngularHistogram> histograms(double rotation_rad, HistogramNorm norm) const;

 private:
  std::vector<std::size_t> first_;  ///< index of each point's first direction; one more at the end
  std::vector<double> directions_rad_;
};

}  // namespace shapemap
