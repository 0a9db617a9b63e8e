// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "shapemap/core/angles.hpp"
#include "shapemap/core/numbers.hpp"
#include "shapemap/core/pose2.hpp"

/// The numbers of how a robot is followed in a map that is known.
namespace shapemap {

struct RedundancyNumbers {
  std::size_t keyframes_in_use = 16;
  double sure_edge = 0.99;
  PoseTolerance as_in_map{0.25, 3 * kDegree};
  std::size_t replacements_tried = 3;
  std::size_t in_doubt_near = 24;
  double right_map = 0.95;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"keyframes_in_use", "the last so many keyframes are always kept",
                      "set by hand: those to come are compared to them"},
          self.keyframes_in_use);
    visit(NumberField{"sure_edge", "an edge this probable is as good as one that loops hold",
                      "set by hand; it equals --verify-below, which may be 0 to verify no edge: then none would be in "
                      "doubt here"},
          self.sure_edge);
    visit(NumberField{"as_in_map", "scans of one place must put each other where the map has them to this",
                      "set by hand: one of them then replaces the other for good; tighter than where a map is sought "
                      "(`inference.agreement.agrees`)"},
          self.as_in_map);
    visit(NumberField{"replacements_tried", "keyframes at a place that are asked whether they can replace another",
                      "set by hand, for speed: the nearest are the likeliest"},
          self.replacements_tried);
    visit(NumberField{"in_doubt_near", "keyframes so near along the way to one that does not show its place stay",
                      "set by hand; it equals `localizer.look_ahead`, which counts keyframes to come"},
          self.in_doubt_near);
    visit(NumberField{"right_map", "the share of keyframes at known places that must show what was there before",
                      "of a map that is right nearly all do; where rows of like rooms are laid on each other, a fourth "
                      "does not"},
          self.right_map);
  }
};

struct PlaceNumbers {
  double known_tells = 0.5;
  double unknown_tells = -2.0;
  double sure_of_place = 5.0;
  double least_log_odds = 8.0;
  double least_lead = 4.0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    const char* const reason =
        "set by hand: as if 95 % of keyframes were known at the right place, and 60 % at one that looks alike";
    visit(NumberField{"known_tells", "log odds for a place by a keyframe that is known there", reason},
          self.known_tells);
    visit(NumberField{"unknown_tells", "and by one that is not known, though somebody has been there", reason},
          self.unknown_tells);
    visit(NumberField{"sure_of_place", "the log odds of a robot that is sure of where it is",
                      "set by hand: two places that look otherwise are put down to change, a third is not"},
          self.sure_of_place);
    visit(NumberField{"least_log_odds", "log odds of a stretch at a place where it is laid",
                      "set by hand: at least sixteen of its keyframes are known"},
          self.least_log_odds);
    visit(NumberField{"least_lead", "and what it must lead by over any other place",
                      "set by hand: eight keyframes more are known"},
          self.least_lead);
  }
};

struct LocalizerNumbers {
  double error_of_new = 0.25;
  double least_of_new = 2.0;
  std::size_t look_ahead = 24;
  std::size_t shortest = 16;
  std::size_t lag = 12;
  std::size_t most_tried = 16;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"error_of_new", "log odds that a keyframe costs where nobody has been",
                      "set by hand: errors add up there"},
          self.error_of_new);
    visit(NumberField{"least_of_new", "but the log odds fall no lower than this by it",
                      "errors by themselves do not get a robot lost"},
          self.least_of_new);
    visit(NumberField{"look_ahead", "keyframes that are looked at to decide on an edge in doubt",
                      "set by hand: where so many tell nothing, none will"},
          self.look_ahead);
    visit(NumberField{"shortest", "a shorter stretch is not laid anywhere",
                      "set by hand: fewer keyframes do not tell places apart, even when all are known"},
          self.shortest);
    visit(NumberField{"lag", "the last so many keyframes are not certain yet",
                      "set by hand: a wrong way shows within so many"},
          self.lag);
    visit(NumberField{"most_tried", "places of a stretch that are tried, likeliest first", "set by hand, for speed"},
          self.most_tried);
  }
};

struct LocalizationNumbers {
  RedundancyNumbers redundancy;
  PlaceNumbers places;
  LocalizerNumbers localizer;

  /// Calls `visit(name, title, group)` for each group; `group` is a struct with `fields`.
  template <class Self, class Visit>
  static void groups(Self& self, Visit&& visit) {
    visit("redundancy", "Keyframes that others can replace", self.redundancy);
    visit("places", "Whether the robot is at a place", self.places);
    visit("localizer", "How the robot is followed", self.localizer);
  }
};

inline constexpr LocalizationNumbers kLocalization{};

}  // namespace shapemap
