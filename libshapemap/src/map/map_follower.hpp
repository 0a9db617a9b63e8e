// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "keyframe_chain.hpp"
#include "keyframe_map.hpp"
#include "shapemap/map/mapping_options.hpp"
#include "stand_ins.hpp"

namespace shapemap {

/// How sure the robot is of where it is.
struct Bearings {
  bool is_lost = false;
  bool is_in_doubt = false;    ///< it may have gone another way than the chain says: that it is where it was expected
                               ///< for a while does not tell
  std::size_t num_unseen = 0;  ///< keyframes since one was known again
};

/// Goes along keyframes that are new to a map, puts them in their places there, and tells which it knows again.
class MapFollower {
 public:
  /// `map` has links and a place for all keyframes; those before `first` are in theirs. `home` is the component that
  /// the robot was sure to be in.
  MapFollower(const KeyframeChain& chain, const MappingOptions& options, std::size_t home, std::size_t first,
              Bearings bearings, KeyframeMap& map);

  /// Along keyframes up to `last`; returns where to go on next time: what only begins to be known again is looked at
  /// anew then, and so is a link in doubt of which too little is known of what comes after.
  std::size_t go(std::size_t first, std::size_t last);

  /// Puts a keyframe where the link to it says.
  void expect(std::size_t b);

  const Bearings& bearings() const { return bearings_; }
  /// Per keyframe: what it was known by.
  std::vector<std::optional<StandIn>>& stand_ins() { return stand_ins_; }

 private:
  bool link_exists(std::size_t b) const;
  bool is_in_doubt(std::size_t b) const;
  void step(std::size_t b);
  void get_lost(std::size_t b);
  void know(std::size_t b, StandIn stand_in);
  void hold_back_from(std::size_t b);

  void doubt_link(std::size_t b);
  std::size_t num_known_from(std::size_t b);

  std::vector<StandIn> stand_ins_at(std::size_t b) const;
  std::vector<std::size_t> earlier_at_place(std::size_t b) const;

  const KeyframeChain& chain_;
  const MappingOptions& options_;
  std::size_t home_;
  KeyframeMap& map_;
  Bearings bearings_;
  std::vector<std::optional<StandIn>> stand_ins_;
  std::vector<std::pair<std::size_t, StandIn>> witnesses_;  ///< known again in a row, if it is true
  std::size_t last_known_;                                  ///< of this go; 0: none
  std::size_t lost_;                                        ///< the first keyframe of what may be anywhere
};

}  // namespace shapemap
