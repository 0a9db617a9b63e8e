// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/core/options.hpp"
#include "shapemap/paper/partial_map.hpp"

/// Paper, section III, "scan overlap measure": how much of an aligned query scan covers the target scan.
namespace shapemap {

/// Which target point a query point is compared to: the paper leaves that open.
enum class OverlapRule {
  kNearest,  ///< the nearest one, which must then have a similar tangent direction
  kAny,      ///< the nearest one of those that have a similar tangent direction
};

template <>
struct EnumNames<OverlapRule> {
  static constexpr std::array<std::string_view, 2> names{"nearest", "any"};
};

struct OverlapOptions {
  double slack_m = 0.40;
  double tangent_tolerance_rad = 10 * kDegree;
  OverlapRule rule = OverlapRule::kNearest;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"overlap-slack-m", "overlapping points are within the mean distance and this [m]", 0, 10},
          self.slack_m);
    visit(Field{"overlap-tangent-deg", "and have tangents within this angle [deg]", 0, 180, kDegree},
          self.tangent_tolerance_rad);
    visit(Field{"overlap-rule", "the partner of a query point"}, self.rule);
  }
};

/// A query point, where the pose puts it, and its partner in the target.
struct Partner {
  std::size_t query = 0;
  std::size_t target = 0;
  double distance_m = 0.0;
};

/// Which partners are looked for.
struct PartnerLimits {
  double max_distance_m = 0.0;  ///< the paper's distance threshold
  std::size_t at_least = 0;     ///< the search may give up, with fewer, as soon as so many cannot be reached
};

/// Returns the partner of each query point that has one within the limits.
std::vector<Partner> partners_within(const PartialMap& target, const Shape& query, const Pose2& target_from_query,
                                     const PartnerLimits& limits, const OverlapOptions& options);

/// How many query points have a partner, and how far it is from them on average.
struct ScanOverlap {
  int num_points = 0;            ///< the scan overlap measure
  double mean_distance_m = 0.0;  ///< the overlap distance
};

ScanOverlap scan_overlap(const std::vector<Partner>& partners);

}  // namespace shapemap
