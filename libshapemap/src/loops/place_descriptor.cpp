// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/loops/place_descriptor.hpp"
#include "loops_numbers.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace shapemap {
namespace {

/// The bins are centred at 0, 45, 90, ... degrees, because most angles in buildings are near these.
std::size_t angle_bin(double angle_rad) {
  const double turns = angle_rad / (2.0 * kPi) + 0.5 / static_cast<double>(kDescriptorAngles);
  const auto bin = static_cast<std::size_t>((turns - std::floor(turns)) * static_cast<double>(kDescriptorAngles));
  return std::min(bin, kDescriptorAngles - 1);
}

}  // namespace

PlaceDescriptor place_descriptor(const ScanView& view) {
  const DescriptorNumbers& numbers = kLoops.descriptor;
  PlaceDescriptor descriptor{};
  const std::size_t stride = std::max<std::size_t>(1, view.size() / numbers.most_points);
  for (std::size_t i = 0; i < view.size(); i += stride) {
    for (std::size_t j = 0; j < view.size(); j += stride) {
      const Point2 between_m = view.points[j].p_m - view.points[i].p_m;
      const double distance_m = between_m.norm();
      const auto distance_bin = static_cast<std::size_t>(distance_m / numbers.distance_bin_m);
      if (distance_m < numbers.least_distance_m || distance_bin >= kDescriptorDistances) continue;
      const double from_rad = view.points[i].tangent_rad;
      const std::size_t turn = angle_bin(view.points[j].tangent_rad - from_rad);
      const std::size_t side = angle_bin(std::atan2(between_m.y(), between_m.x()) - from_rad);
      descriptor[(distance_bin * kDescriptorAngles + turn) * kDescriptorAngles + side] += 1.0F;
    }
  }
  float sum = 0.0F;
  for (const float count : descriptor) sum += count;
  if (sum == 0.0F) return descriptor;
  for (float& count : descriptor) count = std::sqrt(count / sum);
  return descriptor;
}

double similarity(const PlaceDescriptor& a, const PlaceDescriptor& b) {
  using Bins = Eigen::Map<const Eigen::Matrix<float, static_cast<int>(kDescriptorBins), 1>>;
  return static_cast<double>(Bins(a.data()).dot(Bins(b.data())));
}

std::vector<LikelyPlace> PlaceIndex::most_alike(std::size_t node, std::size_t end, std::size_t count) const {
  std::vector<LikelyPlace> places;
  places.reserve(end);
  for (std::size_t other = 0; other < end; ++other) {
    places.push_back({other, similarity(descriptors_[node], descriptors_[other])});
  }
  const auto less_alike = [](const LikelyPlace& a, const LikelyPlace& b) {
    return a.similarity != b.similarity ? a.similarity < b.similarity : a.node > b.node;
  };
  std::make_heap(places.begin(), places.end(), less_alike);  // A heap is enough, since few places are needed in order.
  std::vector<LikelyPlace> apart;
  while (apart.size() < count && !places.empty()) {
    std::pop_heap(places.begin(), places.end(), less_alike);
    const LikelyPlace place = places.back();
    places.pop_back();
    const bool beside = std::any_of(apart.begin(), apart.end(), [&](const LikelyPlace& other) {
      return std::max(place.node, other.node) - std::min(place.node, other.node) <= 1;
    });
    if (!beside) apart.push_back(place);
  }
  return apart;
}

}  // namespace shapemap
