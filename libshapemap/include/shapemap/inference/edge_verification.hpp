// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/core/observer.hpp"
#include "shapemap/core/options.hpp"
#include "shapemap/graph/edge_support.hpp"
#include "shapemap/loops/loop_detection.hpp"
#include "shapemap/matching/visibility.hpp"

/// Edge verification asks all scans of two submaps about the candidates of an edge that alone joins the two.
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
  std::size_t candidate = 0;  ///< the most probable or joined one; that of the map where the observer asked to stop
  double probability = 0.0;   ///< that the candidate is right; 0 where the edge was not verified
  bool joins = false;         ///< whether the edge joins its two submaps
  std::vector<EdgeSupport> support_by_others;  ///< of each candidate; empty where the edge was not verified
  std::vector<double> parallel_support;        ///< of each candidate, by a parallel edge: log odds, 0 or more
};

struct VerifiedMap {
  std::vector<Pose2> map_from_node;
  std::vector<std::size_t> submap_of_node;  ///< joined submaps share the number of one of them
  std::vector<VerifiedEdge> edges;          ///< of each doubtful edge
};

/// The poses of a map whose submaps are each right in themselves.
struct SubmapPoses {
  std::vector<Pose2> map_from_node;
  std::vector<std::size_t> submap_of_node;  ///< the nodes of a submap share a number
};

struct EdgeVerification {
  const VisibilityOptions& visibility;
  double least_probability = 0.0;  ///< less probable edges do not join submaps
};

/// Joins submaps at the doubtful edges, the most probable edge first, since larger submaps tell more of the other
/// edges.
///
/// A candidate is worth its own score and the balance of all pairs of scans of the two submaps (MapScore::of_pair())
/// that are near each other along the trajectory. It is worth less where its two scans constrain it in no direction,
/// and more where the map has it. It is also worth more where a parallel edge, which joins the same two submaps, says
/// the same: if somebody walks by, all other scans speak against the right place, but the edges there and back may
/// agree. A multinomial logit gives the probability of each place, and that none of the candidates is right, which is
/// likelier the less the two scans see. A place to which the best candidate only slides, along a corridor, counts for
/// it in part.
///
/// An edge that is less probable than EdgeVerification::least_probability is not joined. Parallel edges that agree with
/// a joined one are joined with it and get its probability. When the observer asks to stop, the remaining edges stay as
/// they were.
VerifiedMap verify_edges(const NodeViews& views, SubmapPoses submaps, const std::vector<Edge>& doubtful,
                         const EdgeVerification& options, const Execution& execution);

}  // namespace shapemap
