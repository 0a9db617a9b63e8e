// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/core/observer.hpp"
#include "shapemap/core/options.hpp"
#include "shapemap/graph/edge_support.hpp"
#include "shapemap/loops/loop_detection.hpp"
#include "shapemap/matching/visibility.hpp"

/// What the scans of two pieces of a map, all of them, say of an alignment that alone joins the two.
namespace shapemap {

struct EdgeVerificationOptions {
  double doubt_below = 0.99;
  double clear_above = 0.98;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"verify-below", "a less probable alignment that alone joins two pieces of the map is revised; 0: none",
                0, 1}
              .formerly("revise-below"),
          self.doubt_below);
    visit(Field{"verify-clear-above", "it is searched again, thoroughly, unless it is then as probable as this", 0, 1}
              .formerly("revise-clear-above"),
          self.clear_above);
  }
};

struct VerifiedEdge {
  std::size_t candidate = 0;  ///< the best, or what joins; where the observer asked to stop, that of the map
  double probability = 0.0;   ///< that it is right; 0 where nobody was asked
  bool joins = false;         ///< the two pieces
  std::vector<EdgeSupport> support_by_others;  ///< of each candidate; empty where nobody was asked
  std::vector<double> parallel_support;        ///< of each candidate, by a parallel link: logarithm of odds, 0 or more
};

struct VerifiedMap {
  std::vector<Pose2> map_from_node;
  std::vector<std::size_t> submap_of_node;  ///< pieces that were joined have the number of one of them
  std::vector<VerifiedEdge> edges;          ///< per doubtful link
};

/// A map in submaps, each right in itself.
struct SubmapPoses {
  std::vector<Pose2> map_from_node;
  std::vector<std::size_t> submap_of_node;  ///< a number that the nodes of a submap share
};

/// How edges are verified.
struct EdgeVerification {
  const VisibilityOptions& visibility;
  double least_probability = 0.0;  ///< less probable edges do not join submaps
};

/// Joins the pieces (nodes with the same `submap_of_node`, right to each other) at the doubtful links, the most
/// probable first. A candidate is worth its own score and what all pairs of scans of the two pieces then say
/// (MapScore), as far as they are near each other along the chain, less where its two scans hold it in no direction,
/// and more where the map has it, or where another link that joins the same two pieces says the same: where somebody
/// walks by, all others speak against the place, but the way there and back may be known. From that follows how
/// probable each place is, and that it is none of them (multinomial logit), the more so the less the two scans see. A
/// place that the best only slides to, along a corridor, counts for it in part. What is less probable than
/// EdgeVerification::least_probability is not joined; parallel links that say what was joined are joined with it, as
/// probable as it. Stops early, with the rest of the links as they were, when the observer asks to.
VerifiedMap verify_edges(const NodeViews& views, SubmapPoses submaps, const std::vector<Edge>& doubtful,
                         const EdgeVerification& options, const Execution& execution);

}  // namespace shapemap
