// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "shapemap/core/options.hpp"
#include "shapemap/core/pose2.hpp"
#include "shapemap/paper/filters.hpp"
#include "shapemap/paper/icp.hpp"
#include "shapemap/paper/scan_overlap.hpp"

/// What aligning a query scan to a partial map gives (paper, sections III to V-A), and what led to it.
namespace shapemap {

/// Whether an alignment can be trusted, and if not, why.
enum class PaperStatus {
  kOk,
  kNoShape,                ///< the query or its target has too few shape points
  kNoCorrespondences,      ///< the shapes have no similar structures, or the filters dropped all correspondences
  kTooFewCorrespondences,  ///< fewer correspondences than asked for support the translation
  kTooLittleOverlap,       ///< the scan overlap is a smaller share of the query than asked for
};

template <>
struct EnumNames<PaperStatus> {
  static constexpr std::array<std::string_view, 5> names{"ok", "no-shape", "no-correspondences",
                                                         "too-few-correspondences", "too-little-overlap"};
};

/// The pose of a query scan in the frame of its target's reference, the latest of the target's scans. The paper's
/// method gives neither a probability nor a covariance.
struct PaperAlignment {
  PaperStatus status = PaperStatus::kNoShape;
  std::string reason;              ///< one line with the numbers behind `status`; empty when ok
  Pose2 ref_from_query = kNoPose;  ///< NaN unless ok()

  /// The same after the steps on the way, also where the alignment was refused afterwards.
  Pose2 shape_ref_from_query = kNoPose;  ///< by shape alone, before ICP
  Pose2 icp_ref_from_query = kNoPose;    ///< after ICP and before decoupled ICP

  double rotation_rad = 0.0;     ///< the rotation with the largest scan overlap
  int num_correspondences = 0;   ///< point pairs that the winning translation keeps
  double mean_distance_m = 0.0;  ///< among them, in the segment that gave the translation
  int overlap = 0;               ///< the scan overlap measure after ICP: query points with a partner in the target
  double overlap_ratio = 0.0;    ///< the same as a share of the query's points
  int icp_iterations = 0;        ///< of ICP on the complete scan, without one that was rolled back
  std::vector<Pose2> query_from_sweep;  ///< corrections by decoupled ICP, one for each sweep; identity without it

  /// Seconds that the steps took.
  double match_s = 0.0;  ///< from the similarity of points to the best rotation
  double icp_s = 0.0;
  double decoupled_icp_s = 0.0;

  bool ok() const { return status == PaperStatus::kOk; }
};

/// What one rotation of the query led to.
struct RotationMatch {
  double rotation_rad = 0.0;
  Correspondences lcs;     ///< the hypotheses: a longest common subsequence with each sequence of the target
  Correspondences spread;  ///< those that the collinear filter passed
  Segments segments;       ///< those that the segment filter passed
  SegmentTranslation translation;
  ScanOverlap overlap;

  Pose2 target_from_query() const {
    return {translation.target_from_query_m.x(), translation.target_from_query_m.y(), rotation_rad};
  }
};

/// All intermediate results of one alignment.
struct PaperTrace {
  std::vector<RotationMatch> rotations;  ///< in the order of the grid
  int best_rotation = -1;                ///< index into `rotations`; -1: none had a correspondence
  IcpResult icp;
};

}  // namespace shapemap
