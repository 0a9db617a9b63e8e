// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/align/visibility.hpp"
#include "shapemap/core/observer.hpp"
#include "shapemap/core/options.hpp"
#include "shapemap/graph/loop_hypotheses.hpp"

/// What the scans of two pieces of a map, all of them, say of an alignment that alone joins the two.
namespace shapemap {

struct LinkRevisionOptions {
  double doubt_below = 0.95;
  double clear_certainty = 4.0;
  double least_certainty = 2.5;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"revise-below", "a less probable alignment that alone joins two pieces of the map is revised; 0: none",
                0, 1},
          self.doubt_below);
    visit(
        Field{"revise-clear-certainty",
              "it is searched again, thoroughly, unless it is better than all others, and good, by this, as logarithm "
              "of odds",
              -1000, 1000},
        self.clear_certainty);
    visit(Field{"revise-least-certainty", "it then splits the map unless it is so by this", -1000, 1000},
          self.least_certainty);
  }
};

/// What a doubtful link may be: node `link` to node `link` + 1. The first candidate is the one that is in the map.
struct DoubtfulLink {
  struct Candidate {
    Pose2 a_from_b;
    double score = 0.0;  ///< of these two scans alone: PoseHypothesis::score
  };
  std::size_t link = 0;
  std::vector<Candidate> candidates;  ///< at least one
};

struct RevisedMap {
  std::vector<Pose2> map_from_node;
  std::vector<std::size_t> piece_of_node;  ///< pieces that were joined have the number of one of them
  std::vector<int> choice;                 ///< per doubtful link: the candidate that is taken; kCut: none
  std::vector<double> certainty;           ///< per doubtful link: of that candidate, as logarithm of odds
};

/// Joins the pieces (nodes with the same `piece_of_node`, right to each other) at the doubtful links, the most certain
/// first. A candidate is worth its own score and what all pairs of scans of the two pieces then say (MapEvidence), as
/// far as they are near each other along the chain. The best is as certain as it leads over the best other place, less
/// half of what it is bad by. What is less certain than `least_certainty` is not joined. Stops early, with the rest of
/// the links as they were, when the observer asks to.
RevisedMap revise_links(const NodeViews& views, std::vector<Pose2> map_from_node,
                        std::vector<std::size_t> piece_of_node, const std::vector<DoubtfulLink>& doubtful,
                        const VisibilityOptions& visibility, double least_certainty, int threads,
                        RunObserver& observer);

}  // namespace shapemap
