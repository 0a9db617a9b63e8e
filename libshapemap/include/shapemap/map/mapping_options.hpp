// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shapemap/align/align.hpp"
#include "shapemap/align/robust_align.hpp"
#include "shapemap/core/options.hpp"
#include "shapemap/graph/link_revision.hpp"
#include "shapemap/graph/loop_closing.hpp"
#include "shapemap/graph/loop_hypotheses.hpp"
#include "shapemap/graph/map_refinement.hpp"
#include "shapemap/graph/sub_scan_refinement.hpp"
#include "shapemap/map/deskew.hpp"
#include "shapemap/map/scan_agreement.hpp"
#include "shapemap/scan/returns.hpp"
#include "shapemap/shape/polyline_em.hpp"
#include "shapemap/shape/shape.hpp"

namespace shapemap {

enum class Method {
  kRobust,  ///< any heading and offset, little overlap, and a probability with each alignment
  kPaper,   ///< "Robot Mapping for Rescue Robots"
};

template <>
struct EnumNames<Method> {
  static constexpr std::array<std::string_view, 2> names{"robust", "paper"};
};

/// Which scans others are aligned to.
struct KeyframeOptions {
  double step_m = 0.50;
  double turn_rad = 20 * kDegree;
  int settle_at = 1000;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"keyframe-step-m",
                "a scan nearer than this to a keyframe needs none of its own [m]; 0: each has its own", 0, 10},
          self.step_m);
    visit(Field{"keyframe-turn-deg", "unless it is turned by more [deg]", 0, 180, kDegree}, self.turn_rad);
    visit(Field{"settle-at",
                "when there are so many keyframes, loops are closed and those that are there twice let go; 0: never", 0,
                1000000},
          self.settle_at);
  }
};

/// Whether places are known again.
struct LoopSwitch {
  bool close_loops = true;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"close-loops", "know places again; without it, errors add up along the way"}, self.close_loops);
  }
};

/// How the robust method chains its alignments.
struct SmoothingOptions {
  double companion_weight = 0.5;
  double doubt_below = 0.3;
  int more_references = 2;
  double split_below = 0.7;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"companion-weight", "weight of how a pose goes with the scan before the last", 0, 10},
          self.companion_weight);
    visit(Field{"doubt-below", "a less probable alignment is helped by scans further back", 0, 1}, self.doubt_below);
    visit(Field{"more-references", "so many of them", 0, 10}, self.more_references);
    visit(Field{"split-below", "a less probable alignment that no loop holds splits the map instead", 0, 1},
          self.split_below);
  }
};

struct ChainOptions {
  Method method = Method::kRobust;
  int target_scans = 3;
  int threads = 0;
  int seed = 0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"method", "how scans are aligned"}, self.method);
    visit(Field{"target-scans", "previous scans that make the target of the paper's method", 1, 100},
          self.target_scans);
    visit(Field{"threads", "worker threads, 0: one per processor; the result does not depend on it", 0, 256},
          self.threads);
    visit(Field{"seed", "seed of everything random; neither method draws anything", 0, 2147483647}, self.seed);
  }
};

/// All options of map_log(), grouped by stage.
struct MappingOptions {
  ReturnOptions returns;
  DeskewOptions deskew;  ///< of straightened(), not of map_log()
  PolylineOptions polylines;
  ShapeOptions shape;
  RobustOptions robust;
  KeyframeOptions keyframes;
  SmoothingOptions smoothing;
  LoopSwitch loops;
  LoopSearchOptions loop_search;
  LoopClosingOptions loop_closing;
  RefinementOptions refinement;
  LinkRevisionOptions link_revision;
  SubScanOptions sub_scans;
  AlignOptions align;  ///< of the paper's method
  AgreementOptions agreement;
  ChainOptions chain;

  /// Calls `visit(title, group)` for each group; `group` is a struct with `fields`.
  template <class Self, class Visit>
  static void groups(Self& self, Visit&& visit) {
    visit("Returns", self.returns);
    visit("Sweeps", self.deskew);
    visit("Polylines", self.polylines);
    visit("Shape", self.shape);
    visit("Robust method: views", self.robust.view);
    visit("Robust method: translation votes", self.robust.search.voting);
    visit("Robust method: hypotheses", self.robust.search.hypotheses);
    visit("Robust method: visibility", self.robust.search.visibility);
    visit("Robust method: refinement", self.robust.search.line);
    visit("Robust method: confidence", self.robust.confidence);
    visit("Robust method: keyframes", self.keyframes);
    visit("Robust method: chain", self.smoothing);
    visit("Robust method: loops", self.loops);
    visit("Robust method: places that look alike", self.loop_search);
    visit("Robust method: closing loops", self.loop_closing);
    visit("Robust method: the whole map", self.refinement);
    visit("Robust method: doubtful links", self.link_revision);
    visit("Robust method: sub-scans", self.sub_scans);
    visit("Paper's method: histograms", self.align.histogram);
    visit("Paper's method: similarity", self.align.similarity);
    visit("Paper's method: rotations", self.align.rotation);
    visit("Paper's method: longest common subsequence", self.align.lcs);
    visit("Paper's method: filters", self.align.filters);
    visit("Paper's method: overlap", self.align.overlap);
    visit("Paper's method: ICP", self.align.icp);
    visit("Paper's method: trust", self.align.trust);
    visit("Agreement of scans with the map", self.agreement);
    visit("Chain", self.chain);
  }
};

/// Turns every reading of the paper that was settled by measurement back to the literal one.
void make_strict_paper(MappingOptions& options);

/// Throws ConfigError for the first option that is out of its limits.
void validate_all(const MappingOptions& options);

}  // namespace shapemap
