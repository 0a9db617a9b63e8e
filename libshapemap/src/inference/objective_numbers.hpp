// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "shapemap/core/angles.hpp"
#include "shapemap/core/numbers.hpp"
#include "shapemap/core/pose2.hpp"

/// The numbers of what a map is worth, as a whole and at a doubtful edge. The table is in inference_numbers.hpp.
namespace shapemap {

struct AgreementNumbers {
  PoseTolerance agrees{0.35, 4 * kDegree};
  PoseTolerance contradicts{1.0, 10 * kDegree};
  PoseTolerance same_candidate{0.40, 8 * kDegree};
  PoseTolerance drift_per_node{0.02, 0.15 * kDegree};
  PoseTolerance known{0.03, 0.4 * kDegree};
  std::size_t same_stretch = 12;
  double odometry_slack = 1.3;
  double match_loss = 2.0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"agrees", "a map agrees with a loop or an edge that it is nearer to than this",
                      "set by hand: solving for all poses then brings it there; the smallest of these tolerances"},
          self.agrees);
    visit(NumberField{"contradicts", "a map contradicts a loop or an edge that it is farther from than this",
                      "set by hand: what lies between is not decided by one loop alone"},
          self.contradicts);
    visit(NumberField{"same_candidate", "candidates of a doubtful edge that agree to this are one place",
                      "set by hand before the weights of the verification were fitted, which took it as it is; the "
                      "heading is wider than where loops say the same (`loops.clusters.same`)"},
          self.same_candidate);
    visit(NumberField{"drift_per_node",
                      "matches of two submaps say the same to `loops.clusters.same` and so much more "
                      "for each node between them",
                      "set by hand: odometry drifts within a submap"},
          self.drift_per_node);
    visit(NumberField{"known", "two scans are not compared anew when they moved by less since they were",
                      "set by hand, for speed: less changes nothing that matters"},
          self.known);
    visit(NumberField{"same_stretch", "nodes so near to each other along the way are of one stretch of it",
                      "set by hand: two loops between the same two stretches tell one story; narrower in MapScore "
                      "(`map_score.same_stretch`), where it costs time"},
          self.same_stretch);
    visit(NumberField{"odometry_slack", "distances of the visibility are so many times wider for poses by odometry",
                      "set by hand: two steps in a row place a scan less exactly than one does"},
          self.odometry_slack);
    visit(NumberField{"match_loss", "beyond so many standard deviations a match counts less and less",
                      "set by hand, for loops, joints of submaps and sweeps; tighter where all neighbours are matched "
                      "(`refinement.loss`)"},
          self.match_loss);
  }
};

struct MapScoreWeights {
  double weight = 0.5;
  double agree = 2.0;
  double crossed = -2.0;
  double agree_offset = 0.2;
  double crossed_offset = 0.05;
  double most_by_others = 1.0;
  double unheld = 0.2;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    const char* const reason = "set by hand, never fitted: little overlap must say little either way";
    visit(NumberField{"weight", "what counts of the score in the value of a map",
                      "set by hand: pairs of scans do not tell independently of each other"},
          self.weight);
    visit(NumberField{"agree", "weight of the logarithm of the share of points of a pair that agree", reason},
          self.agree);
    visit(NumberField{"crossed", "weight of the logarithm of the share that is crossed", reason}, self.crossed);
    visit(NumberField{"agree_offset", "is added to the share that agrees", reason}, self.agree_offset);
    visit(NumberField{"crossed_offset", "is added to the share that is crossed", reason}, self.crossed_offset);
    visit(NumberField{"most_by_others", "what a node can gain by all nodes of other stretches",
                      "set by hand: the tenth that looks at the same wall tells nothing new, and where many places are "
                      "laid on each other, pairs that go together by chance would be without number"},
          self.most_by_others);
    visit(NumberField{"unheld", "what counts of a pair that only a long chain without loops holds to each other",
                      "set by hand: such nodes may be metres from where the map has them; how long is "
                      "`loops.aliasing.long_chain`"},
          self.unheld);
  }
};

struct MapScoreNumbers {
  double within_m = 6.0;
  std::size_t least_apart = 2;
  std::size_t same_stretch = 8;
  std::size_t stride = 3;
  double slack = 2.0;
  std::size_t pairs_between = 60;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"within_m", "nodes farther apart are not compared",
                      "set by hand: they see little in common; less than for the few edges in doubt "
                      "(`verification.within_m`)"},
          self.within_m);
    visit(NumberField{"least_apart", "nodes nearer along the way are not compared",
                      "neighbours are matched to each other and tell nothing new"},
          self.least_apart);
    visit(NumberField{"same_stretch", "of nodes farther apart along the way only one pair in four is compared",
                      "set by hand, for speed: there are more than are needed"},
          self.same_stretch);
    visit(NumberField{"stride", "one point in so many is looked at", "set by hand, for speed"}, self.stride);
    visit(NumberField{"slack", "distances of the visibility are so many times wider",
                      "set by hand: the map is not refined yet when it is rated"},
          self.slack);
    visit(NumberField{"pairs_between", "of two submaps about so many pairs are compared, which stand for all",
                      "set by hand, for speed: so many tell enough"},
          self.pairs_between);
  }
};

struct ObjectiveNumbers {
  double least_strength = 4.0;
  std::size_t members_used = 8;
  std::size_t members_kept = 3;
  double least_probability = 1e-3;
  double against_odometry = 3.0;
  double most_unusual = 100.0;
  int iterations = 20;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"least_strength", "weaker clusters of loops are of no account",
                      "set by hand: less than one sure match is worth; more than conflicts need "
                      "(`loops.conflicts.least_strength`)"},
          self.least_strength);
    visit(NumberField{"members_used", "so many matches of a cluster hold it while the map is sought",
                      "set by hand, for speed: more hardly hold it better"},
          self.members_used);
    visit(NumberField{"members_kept", "and so many in the final map",
                      "set by hand: there all neighbours are matched anew and hold it as well"},
          self.members_kept);
    visit(NumberField{"least_probability", "an edge is at least so probable when it is cut",
                      "its log odds stay finite, and to cut it costs nothing"},
          self.least_probability);
    visit(NumberField{"against_odometry", "log odds against a candidate that odometry did not choose",
                      "set by hand: odometry took the neighbours of the edge into account as well"},
          self.against_odometry);
    visit(NumberField{"most_unusual", "steps that are so many times longer than usual are all alike",
                      "submaps that nothing joins lie far apart, and must not cost without limit"},
          self.most_unusual);
    visit(NumberField{"iterations", "iterations of the solver while the map is sought",
                      "set by hand, for speed: many maps are solved for"},
          self.iterations);
  }
};

struct VerificationNumbers {
  double within_m = 8.0;
  std::size_t window = 16;
  int more_effort = 4;
  double loop_variance_m2 = 0.01;
  double loop_variance_rad2 = 0.0012;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"within_m", "scans farther apart say nothing of a doubtful edge", "they see nothing in common"},
          self.within_m);
    visit(NumberField{"window", "nodes farther along the way say nothing of it",
                      "set by hand before the weights were fitted: they lie less exactly"},
          self.window);
    visit(NumberField{"more_effort", "so many times the effort is made where an edge is searched again",
                      "set by hand: only few are"},
          self.more_effort);
    visit(
        NumberField{"loop_variance_m2", "the variance of a closed loop in each direction, when the map is solved anew",
                    "set by hand: 0.1 m of standard deviation"},
        self.loop_variance_m2);
    visit(NumberField{"loop_variance_rad2", "and that of its heading", "set by hand: 2 degrees of standard deviation"},
          self.loop_variance_rad2);
  }
};

struct VerificationWeights {
  double per_score = 0.63;
  double by_others = 2.9;
  double of_map = 1.2;
  double none_of_them = -5.7;
  double none_per_insufficient_view = 25.0;
  double per_log_deviation = -0.5;
  double by_parallel = 0.5;
  double least_score = -12.0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    const char* const fitted =
        "doubtful edges of thinned orebro, belgioioso, aces and csail and of simulated arenas 0-79: multinomial logit "
        "by scripts/evaluate.py fit-edges";
    const char* const fitted_alone =
        "edges as those of the other weights, later and with these as they were: scripts/evaluate.py fit-edges";
    visit(NumberField{"per_score", "log odds of a candidate for its score", fitted}, self.per_score);
    visit(NumberField{"by_others", "log odds for the balance of all other scans of both submaps", fitted},
          self.by_others);
    visit(NumberField{"of_map", "log odds for being what the map has", fitted}, self.of_map);
    visit(NumberField{"none_of_them", "log odds that no candidate is right", fitted}, self.none_of_them);
    visit(NumberField{"none_per_insufficient_view", "and more for the insufficient view of the two scans",
                      "doubtful edges of hard scenes 20-49, all else as it is: scripts/evaluate.py fit-edges "
                      "--shortfall-alone"},
          self.none_per_insufficient_view);
    visit(NumberField{"per_log_deviation", "log odds for log(1 + d), with d metres of deviation where it is held best",
                      fitted_alone},
          self.per_log_deviation);
    visit(NumberField{"by_parallel", "log odds for what a parallel edge says for it", fitted_alone}, self.by_parallel);
    visit(NumberField{"least_score", "a lower score counts as this",
                      "set by hand before the fit: however badly two scans go together, others may know better"},
          self.least_score);
  }
};

}  // namespace shapemap
