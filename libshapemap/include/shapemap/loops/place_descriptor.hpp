// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "shapemap/shape/scan_view.hpp"

/// Place descriptors find places that look alike, whatever the heading.
namespace shapemap {

/// A histogram over pairs of points of a scan: their distance, and the angles of the first tangent to the second one
/// and to the line between them. None of these changes when the scan is turned or shifted. The entries are square roots
/// of the counts, scaled to a vector of length 1.
inline constexpr std::size_t kDescriptorDistances = 12;
inline constexpr std::size_t kDescriptorAngles = 8;
inline constexpr std::size_t kDescriptorBins = kDescriptorDistances * kDescriptorAngles * kDescriptorAngles;
using PlaceDescriptor = std::array<float, kDescriptorBins>;

/// Returns zeros for a view without pairs of points in range.
PlaceDescriptor place_descriptor(const ScanView& view);

/// Returns Bhattacharyya's coefficient of the two histograms: 0 if they have nothing in common, 1 if they are equal.
double similarity(const PlaceDescriptor& a, const PlaceDescriptor& b);

struct LikelyPlace {
  std::size_t node = 0;
  double similarity = 0.0;
};

/// The place descriptors of all nodes.
class PlaceIndex {
 public:
  void add(const PlaceDescriptor& descriptor) { descriptors_.push_back(descriptor); }
  std::size_t size() const { return descriptors_.size(); }

  /// Returns at most `count` nodes below `end` that are most similar to `node`, best first. Of two neighbours it
  /// returns only the better one.
  std::vector<LikelyPlace> most_alike(std::size_t node, std::size_t end, std::size_t count) const;

 private:
  std::vector<PlaceDescriptor> descriptors_;
};

}  // namespace shapemap
