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

/// Of a closed loop.
const Eigen::Matrix3d kLoopCovariance = Eigen::Vector3d(0.01, 0.01, 0.0012).asDiagonal();

double probability(const KeyframeLink& link, const ConfidenceOptions& options) {
  return judged(link.hypotheses, link.choice.alternative, link.choice.margin, options).probability;
}

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
    if (doubtful_.empty()) return false;
    for (DoubtfulLink& doubt : doubtful_) add_candidates(doubt);
    const RevisedMap revised = revise_links(views_, map_.map_from_keyframe, pieces(), doubtful_,
                                            options_.robust.search.visibility, options_.link_revision,
                                            options_.chain.threads, observer_);
    bool any = false;
    for (std::size_t d = 0; d < doubtful_.size(); ++d) {
      if (revised.choice[d] == 0) continue;
      any = true;
      take(doubtful_[d].link, revised.choice[d] == kCut ? kCut : hypothesis_[d][static_cast<std::size_t>(revised.choice[d])]);
    }
    if (!any) return false;
    map_.map_from_keyframe = revised.map_from_node;
    part();
    refine();
    return true;
  }

 private:
  void find() {
    for (std::size_t i = 0; i < chain_.links.size(); ++i) {
      if (map_.link_choice[i] == kCut || map_.held_by_loops[i]) continue;
      if (probability(chain_.links[i], options_.robust.confidence) >= options_.link_revision.doubt_below) continue;
      if (!looks_all_round(*views_[i]) || !looks_all_round(*views_[i + 1])) continue;
      DoubtfulLink doubt;
      doubt.link = i;
      doubtful_.push_back(doubt);
    }
  }

  /// Nodes that hang together without the doubtful links.
  std::vector<std::size_t> pieces() const {
    std::vector<PoseConstraint> sure;
    const auto is_doubtful = [&](std::size_t i) {
      return std::any_of(doubtful_.begin(), doubtful_.end(), [&](const DoubtfulLink& d) { return d.link == i; });
    };
    for (std::size_t i = 0; i < chain_.links.size(); ++i) {
      if (map_.link_choice[i] != kCut && !is_doubtful(i)) sure.push_back({i, i + 1, {}, Eigen::Matrix3d::Identity(), 0});
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

  void add_candidates(DoubtfulLink& doubt) {
    const std::size_t i = doubt.link;
    KeyframeLink& link = chain_.links[i];
    const auto taken = static_cast<std::size_t>(map_.link_choice[i]);
    if (probability(link, options_.robust.confidence) < options_.loop_search.bridge_below) add_bridges(i);
    hypothesis_.push_back({map_.link_choice[i]});
    doubt.candidates.push_back({inverse(map_.map_from_keyframe[i]) * map_.map_from_keyframe[i + 1],
                                link.hypotheses[taken].score});
    for (std::size_t k = 0; k < link.hypotheses.size(); ++k) {
      if (k == taken) continue;
      doubt.candidates.push_back({link.hypotheses[k].ref_from_query, link.hypotheses[k].score});
      hypothesis_.back().push_back(static_cast<int>(k));
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

  void take(std::size_t link, int hypothesis) { map_.link_choice[link] = hypothesis; }

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
      const PoseHypothesis& pose = chain_.links[i].hypotheses[static_cast<std::size_t>(map_.link_choice[i])];
      known.push_back({i, i + 1, pose.ref_from_query, pose_covariance(pose.fit), 0.0});
    }
    add_loops(known);
    map_.map_from_keyframe = refine_map(views_, map_.map_from_keyframe, known, options_.robust.search,
                                        options_.refinement, options_.chain.threads, observer_);
  }

  const MappingOptions& options_;
  RunObserver& observer_;
  KeyframeChain& chain_;
  KeyframeMap& map_;
  NodeViews views_;
  std::vector<DoubtfulLink> doubtful_;
  std::vector<std::vector<int>> hypothesis_;  ///< per doubtful link and candidate
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
