// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shapemap/core/options.hpp"
#include "shapemap/paper/filters.hpp"
#include "shapemap/paper/icp.hpp"
#include "shapemap/paper/scan_overlap.hpp"
#include "shapemap/paper/similarity.hpp"
#include "shapemap/scan/returns.hpp"
#include "shapemap/shape/angular_histogram.hpp"
#include "shapemap/shape/polyline_em.hpp"
#include "shapemap/shape/shape.hpp"

/// The constants of the paper, sections II to V-A. Where its words allow more than one reading, the defaults are those
/// that did better; read_literally() turns them back.
namespace shapemap {

/// Section II-C: what a query scan is aligned to.
struct TargetOptions {
  int target_scans = 3;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"target-scans", "previous scans that make the target of the paper's method", 1, 100},
          self.target_scans);
  }
};

/// Section III: the rotations of the query scan for which shapes are matched.
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

/// Whether the target is one long sequence of points or one for each of its scans.
enum class LcsTarget { kPerScan, kConcatenated };

template <>
struct EnumNames<LcsTarget> {
  static constexpr std::array<std::string_view, 2> names{"per-scan", "concatenated"};
};

/// Section II-C: the sequences of which the longest common subsequence is taken.
struct LcsOptions {
  LcsTarget target = LcsTarget::kPerScan;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"lcs-target", "one LCS for each target scan, or one for all of them in a row"}, self.target);
  }
};

/// When an alignment is not trusted. The paper trusts each of them, but then one scan that cannot be aligned spoils the
/// rest of the map.
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

/// All options of one alignment, in the order of the paper's steps.
struct PaperOptions {
  TargetOptions target;
  HistogramOptions histogram;
  SimilarityOptions similarity;
  RotationOptions rotation;
  LcsOptions lcs;
  FilterOptions filters;
  OverlapOptions overlap;
  IcpOptions icp;
  TrustOptions trust;

  /// Calls `visit(title, group)` for each group; `group` is a struct with `fields`.
  template <class Self, class Visit>
  static void groups(Self& self, Visit&& visit) {
    visit("Paper's method: target", self.target);
    visit("Paper's method: histograms", self.histogram);
    visit("Paper's method: similarity", self.similarity);
    visit("Paper's method: rotations", self.rotation);
    visit("Paper's method: longest common subsequence", self.lcs);
    visit("Paper's method: filters", self.filters);
    visit("Paper's method: overlap", self.overlap);
    visit("Paper's method: ICP", self.icp);
    visit("Paper's method: trust", self.trust);
  }
};

/// All that a PaperMapper is told: how a scan becomes a shape (section II-A), and how shapes are aligned.
struct PaperMapperOptions {
  ReturnOptions returns;
  PolylineOptions polylines;
  ShapeOptions shape;
  PaperOptions method;
};

/// Throws ConfigError for the first option that is out of its limits.
void validate_all(const PaperMapperOptions& options);

/// Turns every reading of the paper that was settled by measurement back to the literal one.
void read_literally(PaperOptions& options);

}  // namespace shapemap
