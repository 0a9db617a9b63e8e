// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "graph/keyframe_graph.hpp"
#include "inference/optimized_map.hpp"
#include "localization_numbers.hpp"
#include "place_verification.hpp"
#include "redundant_keyframes.hpp"
#include "shapemap/inference/robust_options.hpp"
#include "shapemap/loops/loop_clusters.hpp"

namespace shapemap {

/// What is known of the robot's place after the last keyframe that is certain.
struct LocalizationState {
  bool is_lost = false;
  double log_odds = kLocalization.places.sure_of_place;  ///< log odds that the robot is where it is expected
};

/// Where a Localizer starts.
struct LocalizationStart {
  std::size_t active_component = 0;  ///< the component that the robot was surely in
  std::size_t first = 0;             ///< the first keyframe that is new to the map
  LocalizationState state;           ///< the state at the keyframe before it
};

/// Localizes keyframes that are new to a map, one after the other, and finds those that the map can replace. A single
/// recognised keyframe proves little, so the log odds that the robot is where it is expected are followed: each
/// keyframe that the map recognises raises them, and each that shows something else than the map lowers them. When they
/// are too low, or after a doubtful edge that keyframes do not decide, the robot is lost, and all places where it may
/// be are tried.
class Localizer {
 public:
  /// `map` has an entry for each edge and keyframe; the keyframes before `start.first` have their poses. `loops` are
  /// earlier places where keyframes may be. All but `start` must outlive the object.
  Localizer(const KeyframeGraph& graph, const RobustOptions& options, const LocalizationStart& start,
            const std::vector<EdgeCandidate>& loops, OptimizedMap& map);

  /// Localizes the keyframes before `last`. Returns the first that is not certain yet: from there, and with the state()
  /// there, another call must start over.
  std::size_t go(std::size_t last);

  /// Places a keyframe by the odometry edge to it.
  void expect(std::size_t b);

  const LocalizationState& state() const { return state_; }
  /// Returns for each keyframe the one of the map that can replace it, where there is one.
  std::vector<std::optional<ReplacementKeyframe>>& redundant() { return redundant_; }

 private:
  bool edge_exists(std::size_t b) const;
  bool is_in_doubt(std::size_t b) const;

  bool step(std::size_t b);
  void make_certain(std::size_t end);
  void forget_pending();
  void replace(std::size_t b, ReplacementKeyframe replacement);
  void constrain_edges_before(std::size_t b);

  bool decide(std::size_t b);
  void get_lost();
  void relocalize(std::size_t last);
  std::size_t end_of_stretch(std::size_t first, std::size_t last) const;
  std::size_t place(std::size_t first, std::size_t last);
  std::vector<std::pair<std::size_t, Pose2>> candidates(std::size_t first, std::size_t last) const;
  void accept(std::size_t first, PlacedStretch stretch);
  void choose_candidate_as_in_map(std::size_t b);

  const KeyframeGraph& graph_;
  const RobustOptions& options_;
  const std::vector<EdgeCandidate>& loops_;
  OptimizedMap& map_;
  PlaceVerification verification_;
  std::vector<std::optional<ReplacementKeyframe>> redundant_;

  LocalizationState state_;  ///< the state at keyframe open_ - 1
  double log_odds_;          ///< log odds that the robot is where it is expected now
  std::size_t open_;         ///< the first keyframe that is not certain yet
  std::size_t good_;         ///< the first keyframe that only later ones can make certain
  std::vector<std::pair<std::size_t, ReplacementKeyframe>> pending_;  ///< replacements from open_ on, not certain yet
  std::size_t last_informative_;  ///< the last keyframe that changed the odds, or the first
  std::size_t last_replaced_;     ///< the last keyframe with a replacement, or the one before the first
};

}  // namespace shapemap
