// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shapemap/core/options.hpp"
#include "shapemap/deskew/deskew.hpp"
#include "shapemap/grid/scan_consistency.hpp"
#include "shapemap/inference/robust_options.hpp"
#include "shapemap/paper/paper_options.hpp"
#include "shapemap/scan/returns.hpp"
#include "shapemap/shape/polyline_em.hpp"
#include "shapemap/shape/shape.hpp"

namespace shapemap {

enum class Method {
  kRobust,  ///< the method for any heading and offset and little overlap, which states a probability for each match
  kPaper,   ///< the method of "Robot Mapping for Rescue Robots"
};

template <>
struct EnumNames<Method> {
  static constexpr std::array<std::string_view, 2> names{"robust", "paper"};
};

struct RunOptions {
  Method method = Method::kRobust;
  int threads = 0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"method", "how scans are aligned"}, self.method);
    visit(Field{"threads", "worker threads, 0: one per processor; the result does not depend on it", 0, 256},
          self.threads);
  }
};

/// All options of map_log(), grouped by stage.
struct MappingOptions {
  ReturnOptions returns;
  DeskewOptions deskew;  ///< options of straightened(), which map_log() does not read
  PolylineOptions polylines;
  ShapeOptions shape;
  RobustOptions robust;
  PaperOptions paper;
  ConsistencyOptions consistency;
  RunOptions run;

  /// Calls `visit(title, group)` for each group; `group` is a struct with `fields`.
  template <class Self, class Visit>
  static void groups(Self& self, Visit&& visit) {
    visit("Returns", self.returns);
    visit("Sweeps", self.deskew);
    visit("Polylines", self.polylines);
    visit("Shape", self.shape);
    visit("Robust method: views", self.robust.matcher.view);
    visit("Robust method: translation votes", self.robust.matcher.search.voting);
    visit("Robust method: hypotheses", self.robust.matcher.search.candidates);
    visit("Robust method: visibility", self.robust.matcher.search.visibility);
    visit("Robust method: refinement", self.robust.matcher.search.line);
    visit("Robust method: confidence", self.robust.matcher.confidence);
    visit("Robust method: keyframes", self.robust.keyframes);
    visit("Robust method: chain", self.robust.front_end);
    visit("Robust method: loops", self.robust.loops);
    visit("Robust method: places that look alike", self.robust.loop_detection);
    visit("Robust method: closing loops", self.robust.map_search);
    visit("Robust method: the whole map", self.robust.refinement);
    visit("Robust method: doubtful links", self.robust.edge_verification);
    visit("Robust method: sub-scans", self.robust.sweep_refinement);
    PaperOptions::groups(self.paper, visit);
    visit("Agreement of scans with the map", self.consistency);
    visit("Run", self.run);
  }
};

/// Chooses the paper's method, and sets every interpretation of the paper that was chosen by measurement back to the
/// literal one, also for its input.
void make_strict_paper(MappingOptions& options);

/// Throws ConfigError for the first option that is out of its limits.
void validate_all(const MappingOptions& options);

}  // namespace shapemap
