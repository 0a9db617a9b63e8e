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

/// Stands where there is no pose.
inline constexpr Pose2 kNoPose{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN(),
                               std::numeric_limits<double>::quiet_NaN()};

/// Whether an alignment can be trusted, and if not, why.
enum class MatchStatus {
  kOk,
  kNoShape,                ///< one of the two has too few shape points
  kNoCorrespondences,      ///< no similar structure, or the filters dropped all of it
  kTooFewCorrespondences,  ///< fewer than asked for
  kTooLittleOverlap,       ///< the aligned scans hardly cover each other
  kAmbiguous,              ///< the best pose may well be wrong: others fit about as well, or it fits badly itself
  kDegenerate,             ///< right but for a direction that the scans do not hold, such as along a bare corridor
};

template <>
struct EnumNames<MatchStatus> {
  static constexpr std::array<std::string_view, 7> names{
      "ok",        "no-shape",  "no-correspondences", "too-few-correspondences", "too-little-overlap",
      "ambiguous", "degenerate"};
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

/// The answer of align() and match_scans(). `ref_from_query` takes the query scan to the frame of the reference.
struct ScanMatch {
  MatchStatus status = MatchStatus::kNoShape;
  std::string reason;              ///< one line with the numbers behind `status`; empty when ok
  Pose2 ref_from_query = kNoPose;  ///< NaN unless has_pose()

  /// By the robust method only: the pose that was taken, then the others, best first; the probability that it is
  /// right; and its covariance, in metres and radians, large in directions that the scans do not hold.
  std::vector<RankedPose> ranked;
  double probability = std::numeric_limits<double>::quiet_NaN();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN());

  /// By the paper's method only.
  Pose2 shape_ref_from_query = kNoPose;  ///< the same before ICP, from shape alone
  Pose2 icp_ref_from_query = kNoPose;    ///< the same after ICP and before decoupled ICP
  double rotation_rad = 0.0;             ///< the rotation of the grid that won
  int num_correspondences = 0;           ///< that the winning translation keeps
  double mean_distance_m = 0.0;          ///< among them, in the segment that gave the translation
  int overlap = 0;                       ///< scan overlap after the last step: query points with a partner
  double overlap_ratio = 0.0;            ///< the same as a share of the query's points
  int icp_iterations = 0;
  std::vector<Pose2> query_from_sweep;  ///< corrections by decoupled ICP, one per sub-scan; identity without

  /// Seconds spent per stage.
  double match_s = 0.0;
  double icp_s = 0.0;
  double decoupled_icp_s = 0.0;

  bool ok() const { return status == MatchStatus::kOk; }
  bool has_pose() const { return ok() || status == MatchStatus::kAmbiguous || status == MatchStatus::kDegenerate; }
};

}  // namespace shapemap
