// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "shapemap/shape/scan_view.hpp"

/// Which places look alike, whatever the heading.
namespace shapemap {

/// How often surfaces of a scan lie how far from each other, and turned how against each other and against the line
/// between them: nothing of that changes when the scan is turned or shifted. The square root of the counts, of
/// length 1.
inline constexpr std::size_t kDescriptorDistances = 12;
inline constexpr std::size_t kDescriptorAngles = 8;
inline constexpr std::size_t kDescriptorBins = kDescriptorDistances * kDescriptorAngles * kDescriptorAngles;
using PlaceDescriptor = std::array<float, kDescriptorBins>;

PlaceDescriptor place_descriptor(const ScanView& view);

/// 0: nothing alike, 1: the same. (Bhattacharyya's coefficient.)
double similarity(const PlaceDescriptor& a, const PlaceDescriptor& b);

struct LikelyPlace {
  std::size_t node = 0;
  double similarity = 0.0;
};

/// All signatures, by node.
class PlaceIndex {
 public:
  void add(const PlaceDescriptor& descriptor) { descriptors_.push_back(descriptor); }
  std::size_t size() const { return descriptors_.size(); }

  /// The `count` nodes below `end` that look most like `node`, best first; of neighbours only the better one.
  std::vector<LikelyPlace> most_alike(std::size_t node, std::size_t end, std::size_t count) const;

 private:
  std::vector<PlaceDescriptor> descriptors_;
};

}  // namespace shapemap
