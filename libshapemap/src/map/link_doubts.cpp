// SPDX-License-Identifier: GPL-3.0-or-later
#include "link_doubts.hpp"

#include <algorithm>
#include <cmath>

#include "shapemap/align/robust_align.hpp"
#include "shapemap/core/errors.hpp"
#include "shapemap/graph/link_revision.hpp"
#include "shapemap/graph/loop_closing.hpp"
#include "shapemap/graph/map_refinement.hpp"

namespace shapemap {
namespace {

/// Pieces that nothing joins lie so far apart: no scan sees so far.
constexpr double kApart_m = 1e4;

constexpr int kMoreEffort = 4;

/// Of a closed loop.
const Eigen::Matrix3d kLoopCovariance = Eigen::Vector3d(0.01, 0.01, 0.0012).asDiagonal();

/// What a position does not see tells of no wall that is looked through: of scans that look one way, those of two
/// different corridors go together well enough. Only positions that look all round are judged.
bool looks_all_round(const ScanView& view) {
  constexpr double kAllRound_rad = 330 * kDegree;
  double seen_rad = 0.0;
  for (const RangeImage& image : view.images) seen_rad += image.step_rad * static_cast<double>(image.beams.size());
  return seen_rad >= kAllRound_rad;
}

class LinkDoubts {
 public:
  LinkDoubts(const MappingOptions& options, RunObserver& observer, KeyframeChain& chain, KeyframeMap& map)
      : options_(options), observer_(observer), chain_(chain), map_(map) {
    for (const Keyframe& keyframe : chain.keyframes) views_.push_back(keyframe.view);
  }

  bool run() {
    find();
    if (doubts_.empty()) return false;
    poses_ = map_.map_from_keyframe;
    piece_ = pieces();
    for (const bool thoroughly : {false, true}) {
      for (Doubt& doubt : doubts_) add_candidates(doubt, thoroughly);
      settle();
    }
    for (const Doubt& doubt : doubts_) take(doubt.of_map.link, kCut);
    if (!changed_) return false;
    map_.map_from_keyframe = poses_;
    part();
    refine();
    return true;
  }

 private:
  struct Doubt {
    DoubtfulLink of_map;
    std::vector<int> hypotheses;  ///< per candidate: which of the link's
  };

  /// Joins what is certain by the candidates that there are; the rest stays in doubt.
  void settle() {
    std::vector<DoubtfulLink> doubtful;
    for (const Doubt& doubt : doubts_) doubtful.push_back(doubt.of_map);
    RevisedMap revised = revise_links(views_, poses_, piece_, doubtful, options_.robust.search.visibility,
                                      options_.link_revision, options_.chain.threads, observer_);
    poses_ = std::move(revised.map_from_node);
    piece_ = std::move(revised.piece_of_node);
    std::vector<Doubt> rest;
    for (std::size_t d = 0; d < doubts_.size(); ++d) {
      const int choice = revised.choice[d];
      if (choice == kCut) {
        rest.push_back(std::move(doubts_[d]));
      } else if (choice > 0) {
        take(doubts_[d].of_map.link, doubts_[d].hypotheses[static_cast<std::size_t>(choice)]);
      }
    }
    doubts_ = std::move(rest);
  }

  void find() {
    for (std::size_t i = 0; i < chain_.links.size(); ++i) {
      if (map_.link_choice[i] == kCut || map_.held_by_loops[i]) continue;
      if (link_probability(chain_.links[i], options_.robust.confidence) >= options_.link_revision.doubt_below) continue;
      if (!looks_all_round(*views_[i]) || !looks_all_round(*views_[i + 1])) continue;
      chain_.links[i].num_of_chain = chain_.links[i].hypotheses.size();
      doubts_.push_back({{i, {}}, {}});
    }
  }

  /// Nodes that hang together without the doubtful links.
  std::vector<std::size_t> pieces() const {
    std::vector<PoseConstraint> sure;
    const auto is_doubtful = [&](std::size_t i) {
      return std::any_of(doubts_.begin(), doubts_.end(), [&](const Doubt& doubt) { return doubt.of_map.link == i; });
    };
    for (std::size_t i = 0; i < chain_.links.size(); ++i) {
      if (map_.link_choice[i] != kCut && !is_doubtful(i))
        sure.push_back({i, i + 1, {}, Eigen::Matrix3d::Identity(), 0});
    }
    add_loops(sure);
    return connected_parts(views_.size(), sure);
  }

  void add_loops(std::vector<PoseConstraint>& constraints) const {
    for (const ClosedLoop& loop : map_.loops) {
      constraints.push_back({keyframe_of(loop.a), keyframe_of(loop.b), loop.a_from_b, kLoopCovariance, 0.0});
    }
  }

  std::size_t keyframe_of(std::size_t position) const {
    const auto found = std::lower_bound(chain_.keyframes.begin(), chain_.keyframes.end(), position,
                                        [](const Keyframe& k, std::size_t p) { return k.position_index < p; });
    return static_cast<std::size_t>(found - chain_.keyframes.begin());
  }

  void add_candidates(Doubt& doubt, bool thoroughly) {
    const std::size_t i = doubt.of_map.link;
    KeyframeLink& link = chain_.links[i];
    if (thoroughly) {
      search_again(i);
    } else if (link_probability(link, options_.robust.confidence) < options_.loop_search.bridge_below) {
      add_bridges(i);
    }
    const auto taken = static_cast<std::size_t>(map_.link_choice[i]);
    const Pose2 as_in_map = inverse(map_.map_from_keyframe[i]) * map_.map_from_keyframe[i + 1];
    doubt.hypotheses = {map_.link_choice[i]};
    doubt.of_map.candidates = {{as_in_map, link.hypotheses[taken].score}};
    for (std::size_t k = 0; k < link.hypotheses.size(); ++k) {
      if (k == taken) continue;
      doubt.hypotheses.push_back(static_cast<int>(k));
      doubt.of_map.candidates.push_back({link.hypotheses[k].ref_from_query, link.hypotheses[k].score});
    }
  }

  /// What scans before and after a link say of each other is carried to the link by way of the map.
  void add_bridges(std::size_t i) {
    std::vector<PoseHypothesis>& known = chain_.links[i].hypotheses;
    const std::vector<Pose2>& poses = map_.map_from_keyframe;
    for (const LoopHypothesis& bridge :
         bridges(views_, {i}, options_.robust.search, options_.chain.threads, observer_)) {
      const Pose2 a_from_b =
          inverse(poses[i]) * (poses[bridge.a] * bridge.a_from_b * inverse(poses[bridge.b])) * poses[i + 1];
      if (a_from_b.translation().norm() > max_shift_m(*views_[i], *views_[i + 1], options_.robust.search.voting)) {
        continue;
      }
      add_if_new(refined_hypothesis(*views_[i], *views_[i + 1], a_from_b, options_.robust.search), known);
    }
  }

  /// With much more effort than a chain can have for each link.
  void search_again(std::size_t i) {
    HypothesisSearchOptions search = options_.robust.search;
    search.voting.peaks *= kMoreEffort;
    search.hypotheses.rotation_peaks *= kMoreEffort;
    search.hypotheses.refined *= kMoreEffort;
    search.hypotheses.kept *= kMoreEffort;
    for (const PoseHypothesis& pose : pose_hypotheses(*views_[i], *views_[i + 1], search)) {
      add_if_new(pose, chain_.links[i].hypotheses);
    }
  }

  void take(std::size_t link, int hypothesis) {
    map_.link_choice[link] = hypothesis;
    changed_ = true;
  }

  /// Moves what is not joined any more apart.
  void part() {
    std::vector<PoseConstraint> joined;
    for (std::size_t i = 0; i < chain_.links.size(); ++i) {
      if (map_.link_choice[i] != kCut) joined.push_back({i, i + 1, {}, Eigen::Matrix3d::Identity(), 0.0});
    }
    add_loops(joined);
    map_.component = connected_parts(views_.size(), joined);
    for (std::size_t n = 0; n < views_.size(); ++n) {
      if (map_.component[n] > 0) map_.map_from_keyframe[n].x_m += kApart_m * static_cast<double>(map_.component[n]);
    }
  }

  void refine() {
    std::vector<PoseConstraint> known;
    for (std::size_t i = 0; i < chain_.links.size(); ++i) {
      if (map_.link_choice[i] == kCut) continue;
      known.push_back(link_constraint(chain_, i, static_cast<std::size_t>(map_.link_choice[i])));
    }
    add_loops(known);
    map_.map_from_keyframe = refine_map(views_, map_.map_from_keyframe, known, options_.robust.search,
                                        options_.refinement, options_.chain.threads, observer_)
                                 .map_from_node;
  }

  const MappingOptions& options_;
  RunObserver& observer_;
  KeyframeChain& chain_;
  KeyframeMap& map_;
  NodeViews views_;
  std::vector<Doubt> doubts_;
  std::vector<Pose2> poses_;        ///< of the pieces, as far as they are joined
  std::vector<std::size_t> piece_;  ///< of each node
  bool changed_ = false;
};

}  // namespace

bool revise_doubtful_links(const MappingOptions& options, RunObserver& observer, KeyframeChain& chain,
                           KeyframeMap& map) {
  try {
    return LinkDoubts(options, observer, chain, map).run();
  } catch (const Interrupted&) {
    return false;
  }
}

}  // namespace shapemap
