// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/loops/place_descriptor.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace shapemap {
namespace {

constexpr double kDistanceBin_m = 0.75;
constexpr double kLeastDistance_m = 0.30;  // nearer points lie on the same surface
constexpr std::size_t kMaxPoints = 150;

/// Bins are centred about 0, 45, 90, ... degrees, where most of the angles in buildings are.
std::size_t angle_bin(double angle_rad) {
  const double turns = angle_rad / (2.0 * kPi) + 0.5 / static_cast<double>(kSignatureAngles);
  const auto bin = static_cast<std::size_t>((turns - std::floor(turns)) * static_cast<double>(kSignatureAngles));
  return std::min(bin, kSignatureAngles - 1);
}

}  // namespace

PlaceSignature place_signature(const ScanView& view) {
  PlaceSignature signature{};
  const std::size_t stride = std::max<std::size_t>(1, view.size() / kMaxPoints);
  for (std::size_t i = 0; i < view.size(); i += stride) {
    for (std::size_t j = 0; j < view.size(); j += stride) {
      const Point2 between_m = view.points[j].p_m - view.points[i].p_m;
      const double distance_m = between_m.norm();
      const auto distance_bin = static_cast<std::size_t>(distance_m / kDistanceBin_m);
      if (distance_m < kLeastDistance_m || distance_bin >= kSignatureDistances) continue;
      const double from_rad = view.points[i].tangent_rad;
      const std::size_t turn = angle_bin(view.points[j].tangent_rad - from_rad);
      const std::size_t side = angle_bin(std::atan2(between_m.y(), between_m.x()) - from_rad);
      signature[(distance_bin * kSignatureAngles + turn) * kSignatureAngles + side] += 1.0F;
    }
  }
  float sum = 0.0F;
  for (const float count : signature) sum += count;
  if (sum == 0.0F) return signature;
  for (float& count : signature) count = std::sqrt(count / sum);
  return signature;
}

double likeness(const PlaceSignature& a, const PlaceSignature& b) {
  using Bins = Eigen::Map<const Eigen::Matrix<float, static_cast<int>(kSignatureBins), 1>>;
  return static_cast<double>(Bins(a.data()).dot(Bins(b.data())));
}

std::vector<LikelyPlace> PlaceIndex::most_alike(std::size_t node, std::size_t end, std::size_t count) const {
  std::vector<LikelyPlace> places;
  places.reserve(end);
  for (std::size_t other = 0; other < end; ++other) {
    places.push_back({other, likeness(signatures_[node], signatures_[other])});
  }
  const auto less_alike = [](const LikelyPlace& a, const LikelyPlace& b) {
    return a.likeness != b.likeness ? a.likeness < b.likeness : a.node > b.node;
  };
  std::make_heap(places.begin(), places.end(), less_alike);  // few are needed in order
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
