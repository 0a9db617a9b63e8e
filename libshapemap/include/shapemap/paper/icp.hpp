// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "shapemap/core/options.hpp"
#include "shapemap/paper/partial_map.hpp"
#include "shapemap/paper/scan_overlap.hpp"

/// Paper, sections IV and V-A: iterative closest point (ICP) with thresholds of distance and tangent direction and a
/// check of quality.
namespace shapemap {

/// How the distance threshold, within which partners pull, follows from the mean distance of the overlapping points.
enum class IcpGate {
  kFactor,  ///< a multiple of the mean
  kSlack,   ///< the mean at the start and the slack of the scan overlap measure
};

template <>
struct EnumNames<IcpGate> {
  static constexpr std::array<std::string_view, 2> names{"factor", "slack"};
};

struct IcpOptions {
  int max_iterations = 20;
  IcpGate gate = IcpGate::kFactor;
  double gate_factor = 3.0;
  bool decoupled = true;
  double decoupled_max_shift_m = 0.10;
  double decoupled_max_turn_rad = 3 * kDegree;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"icp-max-iterations", "iterations of ICP at most; 0 switches it off", 0, 1000}, self.max_iterations);
    visit(Field{"icp-gate", "how far partners may be: a multiple of the mean distance, or the mean and a slack"},
          self.gate);
    visit(Field{"icp-gate-factor", "that multiple", 0.1, 100}, self.gate_factor);
    visit(Field{"icp-decoupled", "ICP on each sub-scan by itself after ICP on the position"}, self.decoupled);
    visit(Field{"icp-decoupled-max-shift-m", "a larger correction of a sub-scan is no small error, and undone [m]", 0,
                10},
          self.decoupled_max_shift_m);
    visit(Field{"icp-decoupled-max-turn-deg", "likewise [deg]", 0, 180, kDegree}, self.decoupled_max_turn_rad);
  }
};

/// Returns the rigid motion that brings the query points of `partners` closest to their targets in the least squares
/// sense (Arun, Huang and Blostein 1987, in the plane). It needs two partners or more.
Pose2 fit_pose(const PartialMap& target, const Shape& query, const std::vector<Partner>& partners);

/// From where ICP sets out.
struct IcpStart {
  Pose2 target_from_query{};
  double mean_distance_m = 0.0;  ///< among the correspondences that gave the pose
};

struct IcpResult {
  Pose2 target_from_query;
  ScanOverlap overlap;       ///< at that pose
  int iterations = 0;        ///< that were kept
  std::vector<Pose2> steps;  ///< the pose before the first iteration and after each that was kept
};

/// Section IV: refines the pose of the complete query scan. An iteration after which the scan overlap measure is
/// smaller and the overlap distance larger is rolled back, and ends the loop.
IcpResult icp(const PartialMap& target, const Shape& query, const IcpStart& start, const IcpOptions& options,
              const OverlapOptions& overlap_options);

/// Section V-A, "decoupled ICP": refines each sweep of `query` by itself from the pose of the complete scan. Returns
/// the pose of each sweep in the frame of the query, which is the identity for a sweep that nothing pulls, or that is
/// pulled farther than the small errors of taking sweeps allow.
std::vector<Pose2> decoupled_icp(const PartialMap& target, const Shape& query, const IcpStart& start,
                                 const IcpOptions& options, const OverlapOptions& overlap_options);

}  // namespace shapemap
