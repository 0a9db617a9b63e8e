// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "shapemap/core/options.hpp"
#include "shapemap/matching/scan_match.hpp"
#include "shapemap/paper/filters.hpp"
#include "shapemap/paper/icp.hpp"
#include "shapemap/paper/partial_map.hpp"
#include "shapemap/paper/scan_overlap.hpp"
#include "shapemap/paper/similarity.hpp"
#include "shapemap/shape/angular_histogram.hpp"

/// Paper, sections II-C to IV: the pose of a scan in a partial map, by shape.
namespace shapemap {

struct RotationOptions {
  double range_rad = 2 * kDegree;
  double step_rad = 1 * kDegree;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"rotation-range-deg", "rotations from minus this to this are tried [deg]", 0, 180, kDegree},
          self.range_rad);
    visit(Field{"rotation-step-deg", "step between them [deg]", 0.1, 180, kDegree}, self.step_rad);
  }
};

/// When an alignment is not trusted.
struct TrustOptions {
  int min_correspondences = 1;
  double min_overlap_ratio = 0.10;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"min-correspondences", "fewer correspondences than this are not trusted", 1, 100000},
          self.min_correspondences);
    visit(Field{"min-overlap", "nor is a smaller share of overlapping points", 0, 1}, self.min_overlap_ratio);
  }
};

/// Whether the target is one long sequence of points or one for each of its scans.
enum class LcsTarget { kPerScan, kConcatenated };

template <>
struct EnumNames<LcsTarget> {
  static constexpr std::array<std::string_view, 2> names{"per-scan", "concatenated"};
};

struct LcsOptions {
  LcsTarget target = LcsTarget::kPerScan;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"lcs-target", "one LCS for each target scan, or one for all of them in a row"}, self.target);
  }
};

/// What a scan is aligned to.
struct TargetOptions {
  int target_scans = 3;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"target-scans", "previous scans that make the target of the paper's method", 1, 100},
          self.target_scans);
  }
};

struct AlignOptions {
  TargetOptions target;
  HistogramOptions histogram;
  SimilarityOptions similarity;
  RotationOptions rotation;
  LcsOptions lcs;
  FilterOptions filters;
  OverlapOptions overlap;
  IcpOptions icp;
  TrustOptions trust;
  int threads = 1;      ///< does not change the result
  int min_points = 10;  ///< ShapeOptions::min_points
  /// Asked before each rotation and step, if given, from the thread that aligns; false ends it with Interrupted.
  std::function<bool()> keep_going;
};

/// What one rotation of the grid led to.
struct RotationMatch {
  double rotation_rad = 0.0;
  Correspondences lcs;     ///< hypotheses
  Correspondences spread;  ///< those that the collinear filter passed
  Segments segments;       ///< those that the segment filter passed
  SegmentTranslation translation;
  ScanOverlap overlap;

  Pose2 target_from_query() const {
    return {translation.target_from_query_m.x(), translation.target_from_query_m.y(), rotation_rad};
  }
};

/// All intermediate results of one alignment.
struct AlignTrace {
  std::vector<RotationMatch> rotations;  ///< in the order of the grid
  int best_rotation = -1;                ///< index into `rotations`; -1: none had a correspondence
  IcpResult icp;
};

/// The rotations to try: multiples of the step within the range, ascending; a full turn has no angle twice.
std::vector<double> rotation_grid(const RotationOptions& options);

/// The pose of `query` in the frame of `target`, starting from the same heading. Never throws for scans that do not
/// match: see Alignment::status. `trace`, if given, receives everything that led to it.
ScanMatch align(const PartialMap& target, const Shape& query, const AlignOptions& options, AlignTrace* trace = nullptr);

/// The same against a single scan.
ScanMatch align(const Shape& reference, const Shape& query, const AlignOptions& options, AlignTrace* trace = nullptr);

}  // namespace shapemap
