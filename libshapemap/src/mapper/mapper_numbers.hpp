// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "shapemap/core/angles.hpp"
#include "shapemap/core/numbers.hpp"
#include "shapemap/core/pose2.hpp"

/// The numbers of how scans become keyframes, and of when the map is looked at.
namespace shapemap {

struct TrackingNumbers {
  PoseTolerance longest_step{0.20, 10 * kDegree};
  PoseTolerance stands{0.01, 0.5 * kDegree};
  double dense = 0.5;
  double memory = 0.97;
  std::size_t multi_reference_candidates = 2;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"longest_step", "a scan that is followed without a search moves by less from the one before",
                      "set by hand: what moves farther is searched for"},
          self.longest_step);
    visit(NumberField{"stands", "a sensor that moves by less stands",
                      "set by hand: one that stands does not tell how it moves"},
          self.stands);
    visit(NumberField{"dense", "a search at each scan is made where more than this share of scans was attached",
                      "set by hand, for speed: it pays only where scans follow each other closely"},
          self.dense);
    visit(NumberField{"memory", "the share of what was known of that which is left after a scan",
                      "set by hand: about the last thirty scans count"},
          self.memory);
    visit(NumberField{"multi_reference_candidates", "candidates of each keyframe further back that are asked",
                      "set by hand, for speed"},
          self.multi_reference_candidates);
  }
};

struct ThreeScanWeights {
  double agree = 3.0;
  double crossed = -1.5;
  double agree_offset = 0.2;
  double crossed_offset = 0.1;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    const char* const reason =
        "set by hand, never fitted: little overlap must say little either way; what counts of it is "
        "--three-scan-weight";
    visit(NumberField{"agree",
                      "weight of the logarithm of the share of points that agree with the scan before the "
                      "last",
                      reason},
          self.agree);
    visit(NumberField{"crossed", "weight of the logarithm of the share that is crossed", reason}, self.crossed);
    visit(NumberField{"agree_offset", "is added to the share that agrees", reason}, self.agree_offset);
    visit(NumberField{"crossed_offset", "is added to the share that is crossed", reason}, self.crossed_offset);
  }
};

struct UpdateNumbers {
  std::size_t scans_between_updates = 32;
  std::size_t followed_at_once = 64;
  std::size_t first_preview = 8;
  std::size_t most_waiting = 10000;
  double settled_log_odds = 4.6;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"scans_between_updates", "each time so many scans have come it is asked whether enough is new",
                      "set by hand, for speed"},
          self.scans_between_updates);
    visit(NumberField{"followed_at_once", "keyframes that are followed in the map at a time", "set by hand, for speed"},
          self.followed_at_once);
    visit(NumberField{"first_preview",
                      "keyframes of the first preview of the map; each later one has half as many "
                      "again",
                      "set by hand: all previews together cost a few times as much as the last"},
          self.first_preview);
    visit(NumberField{"most_waiting", "scans that may wait for the back end before the caller does",
                      "a recording at 40 scans a second waits for minutes before so many do"},
          self.most_waiting);
    visit(NumberField{"settled_log_odds", "what a settled map says of two of its keyframes, as log odds",
                      "set by hand: a probability of 0.99"},
          self.settled_log_odds);
  }
};

struct MirrorNumbers {
  double least_turn_rad = 5 * kDegree;
  double most_turn_rad = 150 * kDegree;
  double by_chance = 0.5;
  double log_error = -13.8;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"least_turn_rad", "smaller turns are not compared with those that a log records",
                      "set by hand: their direction is not certain"},
          self.least_turn_rad);
    visit(NumberField{"most_turn_rad", "nor are larger ones",
                      "set by hand: they are not certain to be no turns the other way"},
          self.most_turn_rad);
    visit(NumberField{"by_chance", "the share of turns that go the other way by chance", "a toss of a coin"},
          self.by_chance);
    visit(
        NumberField{"log_error", "the logarithm of how probable a wrong warning may be", "1e-6: it is to be believed"},
        self.log_error);
  }
};

struct MapperNumbers {
  TrackingNumbers tracking;
  ThreeScanWeights three_scans;
  UpdateNumbers updates;
  MirrorNumbers mirror;

  /// Calls `visit(name, title, group)` for each group; `group` is a struct with `fields`.
  template <class Self, class Visit>
  static void groups(Self& self, Visit&& visit) {
    visit("tracking", "How scans are tracked", self.tracking);
    visit("three_scans", "What the scan before the last says of a candidate", self.three_scans);
    visit("updates", "When the map is looked at", self.updates);
    visit("mirror", "Whether a log is mirrored", self.mirror);
  }
};

inline constexpr MapperNumbers kMapper{};

}  // namespace shapemap
