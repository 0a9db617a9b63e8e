// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shapemap/align/align.hpp"
#include "shapemap/core/options.hpp"
#include "shapemap/scan/returns.hpp"
#include "shapemap/shape/polyline_em.hpp"
#include "shapemap/shape/shape.hpp"

namespace shapemap {

enum class Method { kPaper };

template <>
struct EnumNames<Method> {
  static constexpr std::array<std::string_view, 1> names{"paper"};
};

struct ChainOptions {
  Method method = Method::kPaper;
  int target_scans = 3;
  int threads = 1;
  int seed = 0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"method", "how scans are aligned"}, self.method);
    visit(Field{"target-scans", "previous scans that make the target of an alignment", 1, 100}, self.target_scans);
    visit(Field{"threads", "worker threads; the result does not depend on it", 1, 256}, self.threads);
    visit(Field{"seed", "seed of everything random; the paper's method draws nothing", 0, 2147483647}, self.seed);
  }
};

/// All options of map_log(), grouped by stage.
struct MappingOptions {
  ReturnOptions returns;
  PolylineOptions polylines;
  ShapeOptions shape;
  AlignOptions align;
  ChainOptions chain;

  /// Calls `visit(title, group)` for each group; `group` is a struct with `fields`.
  template <class Self, class Visit>
  static void groups(Self& self, Visit&& visit) {
    visit("Returns", self.returns);
    visit("Polylines", self.polylines);
    visit("Shape", self.shape);
    visit("Histograms", self.align.histogram);
    visit("Similarity", self.align.similarity);
    visit("Rotations", self.align.rotation);
    visit("Longest common subsequence", self.align.lcs);
    visit("Filters", self.align.filters);
    visit("Overlap", self.align.overlap);
    visit("ICP", self.align.icp);
    visit("Trust", self.align.trust);
    visit("Chain", self.chain);
  }
};

/// Turns every reading of the paper that was settled by measurement back to the literal one.
void make_strict_paper(MappingOptions& options);

/// Throws ConfigError for the first option that is out of its limits.
void validate_all(const MappingOptions& options);

}  // namespace shapemap
