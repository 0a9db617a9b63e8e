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

/// Where the robot is after the last keyframe that is certain.
struct LocalizationState {
  bool is_lost = false;
  double log_odds = kLocalization.places.sure_of_place;  ///< that it is where it is expected
};

/// Goes along keyframes that are new to a map, puts them in their places there, and tells which it knows again. What it
/// knows counts only when what comes after agrees: of the robot's being where it is expected, each keyframe that is
/// known raises the odds, and each that shows something else there lowers them. When they are too low, or after a link
/// in doubt that neither of them decides, the robot is lost: all places that it may be at are tried.
class Localizer {
 public:
  /// `map` has links and a place for all keyframes; those before `first` are in theirs. `home` is the component that
  /// the robot was sure to be in; `bearings` are those at keyframe `first - 1`. `loops` are places where keyframes may
  /// have been before.
  Localizer(const KeyframeGraph& graph, const RobustOptions& options, std::size_t active_component, std::size_t first,
            LocalizationState state, const std::vector<EdgeCandidate>& loops, OptimizedMap& map);

  /// Along keyframes up to `last`; returns where to go on next time, with the bearings() there: what is not certain yet
  /// is looked at anew then.
  std::size_t go(std::size_t last);

  /// Puts a keyframe where the link to it says.
  void expect(std::size_t b);

  const LocalizationState& state() const { return state_; }
  /// Per keyframe: what it was known by.
  std::vector<std::optional<ReplacementKeyframe>>& redundant() { return redundant_; }

 private:
  bool edge_exists(std::size_t b) const;
  bool is_in_doubt(std::size_t b) const;

  bool step(std::size_t b);
  void make_certain(std::size_t end);
  void forget_pending();
  void know(std::size_t b, ReplacementKeyframe replacement);
  void hold_back_from(std::size_t b);

  bool decide(std::size_t b);
  void get_lost();
  void find_way(std::size_t last);
  std::size_t end_of_stretch(std::size_t first, std::size_t last) const;
  std::size_t place(std::size_t first, std::size_t last);
  std::vector<std::pair<std::size_t, Pose2>> candidates(std::size_t first, std::size_t last) const;
  void settle_in(std::size_t first, PlacedStretch stretch);
  void take_edge_as_in_map(std::size_t b);

  const KeyframeGraph& graph_;
  const RobustOptions& options_;
  const std::vector<EdgeCandidate>& loops_;
  OptimizedMap& map_;
  PlaceVerification verification_;
  std::vector<std::optional<ReplacementKeyframe>> redundant_;

  LocalizationState state_;  ///< at keyframe open_ - 1
  double log_odds_;          ///< that the robot is where it is expected now
  std::size_t open_;         ///< the first keyframe that is not certain yet
  std::size_t good_;         ///< the first that will not be without those to come
  std::vector<std::pair<std::size_t, ReplacementKeyframe>> pending_;  ///< known again from there on, if it is true
  std::size_t last_telling_;                                          ///< that raised or lowered the odds, or the first
  std::size_t last_known_;                                            ///< or the one before the first
};

}  // namespace shapemap
