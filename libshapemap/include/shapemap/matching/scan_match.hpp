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

/// The status says whether a match can be trusted, and if not, why.
enum class MatchStatus {
  kOk,
  kNoShape,           ///< one of the two scans has too few shape points
  kNoCandidates,      ///< no pose brings similar surfaces together
  kTooLittleOverlap,  ///< the matched scans hardly see the same surfaces
  kAmbiguous,         ///< the best pose may well be wrong: others fit about as well, or it fits badly itself
  kDegenerate,        ///< the scans leave a direction of the pose unconstrained, as in a bare corridor
};

template <>
struct EnumNames<MatchStatus> {
  static constexpr std::array<std::string_view, 6> names{
      "ok", "no-shape", "no-correspondences", "too-little-overlap", "ambiguous", "degenerate"};
};

/// A candidate in the result of a match, as it is reported.
struct RankedPose {
  Pose2 ref_from_query = kNoPose;
  double score = 0.0;  ///< log odds up to a constant that all poses of a pair share

  /// The following are shares of the points of both scans, by what the other scan saw there; see Visibility.
  double agree = 0.0;    ///< the other scan saw the same surface
  double crossed = 0.0;  ///< a beam of the other scan passed through the point
  double hidden = 0.0;
  double unclear = 0.0;
  double outside = 0.0;
  double cross_agree = 0.0;  ///< as `agree`, of the points on surfaces across the main direction of a scan

  double rms_m = 0.0;  ///< root mean square of the distances of points from the lines through their partners
  int partners = 0;    ///< query points that have a partner
};

/// The answer of match_scans(). `ref_from_query` takes the query scan to the frame of the reference.
struct ScanMatch {
  MatchStatus status = MatchStatus::kNoShape;
  std::string reason;              ///< one line with the numbers behind `status`; empty when ok
  Pose2 ref_from_query = kNoPose;  ///< NaN unless has_pose()
  std::vector<RankedPose> ranked;  ///< the pose that was taken, then the others, best first
  /// The probability that the pose is right; NaN without one.
  double probability = std::numeric_limits<double>::quiet_NaN();
  /// The covariance of (x, y, theta), in metres and radians, is large in directions that the scans do not constrain.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN());

  bool ok() const { return status == MatchStatus::kOk; }
  bool has_pose() const { return ok() || status == MatchStatus::kAmbiguous || status == MatchStatus::kDegenerate; }
};

}  // namespace shapemap
