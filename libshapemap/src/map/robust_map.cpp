// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <map>

#include "chains.hpp"
#include "keyframe_chain.hpp"
#include "keyframe_map.hpp"
#include "link_doubts.hpp"
#include "shapemap/align/robust_align.hpp"
#include "shapemap/core/errors.hpp"
#include "shapemap/graph/loop_closing.hpp"
#include "shapemap/scan/joined_logs.hpp"
#include "sub_scan_poses.hpp"

namespace shapemap {
namespace {

/// Gives each position of the log its place in `result`.
class Placing {
 public:
  Placing(const Log& log, const KeyframeChain& chain, const KeyframeMap& map, const SubScanCorrections& sub_scans,
          const MappingOptions& options, TraceSink* sink, MapResult& result)
      : log_(log), chain_(chain), map_(map), sub_scans_(sub_scans), options_(options), sink_(sink), result_(result) {}

  void run() {
    auto attached = chain_.attached.begin();
    for (std::size_t i = 0; i < chain_.keyframes.size(); ++i) {
      place_keyframe(i);
      for (; attached != chain_.attached.end() && attached->keyframe == i; ++attached) place_attached(*attached);
    }
    for (Fragment& fragment : result_.fragments) {
      const Pose2 first_from_map = inverse(fragment.positions.front().map_from_robot);
      for (PlacedPosition& placed : fragment.positions) placed.map_from_robot = first_from_map * placed.map_from_robot;
    }
  }

 private:
  void place_keyframe(std::size_t i) {
    PositionResult& outcome = result_.positions[chain_.keyframes[i].position_index];
    if (i > 0) judge(i - 1, outcome);
    outcome.fragment = fragment_of(i);
    outcome.starts_fragment = i == 0 || map_.component[i] != map_.component[i - 1];
    PlacedPosition& placed = add(outcome, map_.map_from_keyframe[i]);
    if (!sub_scans_.empty()) placed.robot_from_sub_scan = sub_scans_[i];
  }

  /// What the alignment to the keyframe before says, now that the whole map has.
  void judge(std::size_t link, PositionResult& outcome) const {
    outcome.held_by_loops = map_.held_by_loops[link];
    const std::size_t before = chain_.keyframes[link].position_index;
    if (part_with(log_, before) != part_with(log_, outcome.position_index)) return;  // there is nothing to align to
    const std::vector<PoseHypothesis>& hypotheses = chain_.links[link].hypotheses;
    const Choice& choice = chain_.links[link].choice;
    const bool is_cut = map_.link_choice[link] == kCut;
    const std::size_t taken = is_cut ? choice.alternative : static_cast<std::size_t>(map_.link_choice[link]);
    const bool is_first_choice = taken == choice.alternative;
    double margin = choice.margin;
    if (!is_first_choice) margin = hypotheses[taken].score - hypotheses[choice.alternative].score;
    outcome.alignment = judged(hypotheses, taken, margin, options_.robust.confidence);
    outcome.reason = outcome.alignment.reason;
    if (is_cut && !hypotheses.empty() && outcome.reason.empty()) {
      outcome.reason =
          outcome.held_by_loops ? "loops speak against it" : "less probable than it takes not to split the map";
    }
    if (sink_ && !hypotheses.empty()) {
      const std::size_t reference = chain_.keyframes[link].position_index;
      sink_->on_choice({reference, outcome.position_index, taken, margin});
    }
  }

  void place_attached(const AttachedScan& scan) {
    PositionResult& outcome = result_.positions[scan.position_index];
    outcome.alignment = judged({scan.pose}, 0, kFullMargin, options_.robust.confidence);
    outcome.is_keyframe = false;
    outcome.fragment = fragment_of(scan.keyframe);
    add(outcome, map_.map_from_keyframe[scan.keyframe] * scan.pose.ref_from_query);
  }

  /// Fragments are numbered in the order of the log.
  int fragment_of(std::size_t keyframe) {
    const auto [found, is_new] =
        fragment_of_component_.try_emplace(map_.component[keyframe], static_cast<int>(result_.fragments.size()));
    if (is_new) result_.fragments.emplace_back();
    return found->second;
  }

  PlacedPosition& add(const PositionResult& outcome, const Pose2& map_from_robot) {
    PlacedPosition placed;
    placed.position_index = outcome.position_index;
    placed.timestamp_s = outcome.timestamp_s;
    placed.map_from_robot = map_from_robot;
    placed.robot_from_sub_scan.resize(log_.positions[placed.position_index].sub_scans.size());
    std::vector<PlacedPosition>& positions = result_.fragments[static_cast<std::size_t>(outcome.fragment)].positions;
    positions.push_back(std::move(placed));
    return positions.back();
  }

  const Log& log_;
  const KeyframeChain& chain_;
  const KeyframeMap& map_;
  const SubScanCorrections& sub_scans_;
  const MappingOptions& options_;
  TraceSink* sink_;
  MapResult& result_;
  std::map<std::size_t, int> fragment_of_component_;
};

KeyframeMap map_of(const KeyframeChain& chain, const MappingOptions& options, RunObserver& observer,
                   AlignmentStore* store) {
  if (!options.loops.close_loops) return map_of_chain(chain, options);
  try {
    return map_with_loops(chain, options, observer, store);
  } catch (const Interrupted&) {
    return map_of_chain(chain, options);
  }
}

/// Links that were revised have more to choose from than when they were made.
void trace_revised(const KeyframeChain& chain, TraceSink& sink) {
  for (std::size_t i = 0; i < chain.links.size(); ++i) {
    const KeyframeLink& link = chain.links[i];
    if (link.num_of_chain == 0 || link.num_of_chain == link.hypotheses.size()) continue;
    sink.on_link(
        {chain.keyframes[i].position_index, chain.keyframes[i + 1].position_index, link.hypotheses, link.num_of_chain});
  }
}

}  // namespace

void map_robustly(const Log& log, const MappingOptions& options, RunObserver& observer, TraceSink* sink,
                  AlignmentStore* store, MapResult& result) {
  KeyframeChain chain = chain_keyframes(log, options, observer, sink, store, result);
  const auto start = std::chrono::steady_clock::now();
  KeyframeMap map = map_of(chain, options, observer, store);
  SubScanCorrections sub_scans = refine_sub_scans_of_map(log, chain, options, observer, map);
  if (options.loops.close_loops && revise_doubtful_links(options, observer, store, chain, map)) {
    sub_scans = refine_sub_scans_of_map(log, chain, options, observer, map);
  }
  result.times.loops_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.loops = std::move(map.loops);
  if (sink) trace_revised(chain, *sink);
  Placing(log, chain, map, sub_scans, options, sink, result).run();
  if (!observer.keep_going()) throw Interrupted();
}

}  // namespace shapemap
