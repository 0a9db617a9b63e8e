// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "shapemap/core/options.hpp"
#include "shapemap/core/pose2.hpp"

namespace shapemap {

/// Whether a match can be trusted, and if not, why.
enum class MatchStatus {
  kOk,
  kNoShape,           ///< one of the two scans has too few shape points
  kNoCandidates,      ///< no pose brings similar surfaces together
  kTooLittleOverlap,  ///< the matched scans hardly see the same surfaces
  kAmbiguous,         ///< the best pose may well be wrong: others fit about as well, or it fits badly itself
  kDegenerate,        ///< the pose is right but for a direction that the scans do not hold, as in a bare corridor
};

template <>
struct EnumNames<MatchStatus> {
  static constexpr std::array<std::string_view, 6> names{
      "ok", "no-shape", "no-correspondences", "too-little-overlap", "ambiguous", "degenerate"};
};

/// One of the poses that a scan may have.
struct RankedPose {
  Pose2 ref_from_query = kNoPose;
  double score = 0.0;  ///< logarithm of odds, up to a constant that all poses of a pair share

  /// Shares of the points of both scans, by what the other scan saw at their place; see Visibility.
  double agree = 0.0;    ///< they lie on what it saw there
  double crossed = 0.0;  ///< its beams would have had to pass through them
  double hidden = 0.0;
  double unclear = 0.0;
  double outside = 0.0;
  double cross_agree = 0.0;  ///< as `agree`, of the points across the direction that most of a scan runs in

  double rms_m = 0.0;  ///< of the distances of the points from the lines through their partners
  int partners = 0;    ///< query points that have one
};

/// The answer of match_scans(). `ref_from_query` takes the query scan to the frame of the reference.
struct ScanMatch {
  MatchStatus status = MatchStatus::kNoShape;
  std::string reason;              ///< one line with the numbers behind `status`; empty when ok
  Pose2 ref_from_query = kNoPose;  ///< NaN unless has_pose()
  std::vector<RankedPose> ranked;  ///< the pose that was taken, then the others, best first
  /// The probability that the pose is right; NaN without one.
  double probability = std::numeric_limits<double>::quiet_NaN();
  /// The covariance of the pose, in metres and radians, which is large in directions that the scans do not hold.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN());

  bool ok() const { return status == MatchStatus::kOk; }
  bool has_pose() const { return ok() || status == MatchStatus::kAmbiguous || status == MatchStatus::kDegenerate; }
};

}  // namespace shapemap
