// SPDX-License-Identifier: GPL-3.0-or-later
#include "submaps.hpp"

namespace shapemap {

Pose2 Submaps::moved_by(std::size_t edge, const Pose2& a_from_b) const {
  return map_from_node_[edge] * a_from_b * inverse(map_from_node_[edge + 1]);
}

void Submaps::join(std::size_t edge, const Pose2& a_from_b) {
  const Pose2 move = moved_by(edge, a_from_b);
  const std::size_t from = submap_of_node_[edge + 1];
  for (std::size_t n = 0; n < map_from_node_.size(); ++n) {
    if (submap_of_node_[n] != from) continue;
    map_from_node_[n] = move * map_from_node_[n];
    submap_of_node_[n] = submap_of_node_[edge];
  }
}

bool Submaps::are_parallel(std::size_t edge, std::size_t other) const {
  const auto joins = [&](std::size_t from, std::size_t to) {
    return submap_of_node_[other] == from && submap_of_node_[other + 1] == to;
  };
  const std::size_t from = submap_of_node_[edge];
  const std::size_t to = submap_of_node_[edge + 1];
  return from != to && (joins(from, to) || joins(to, from));
}

Pose2 Submaps::carried_to(std::size_t edge, std::size_t parallel, const Pose2& a_from_b) const {
  const Pose2 move = moved_by(parallel, a_from_b);
  const bool is_same_direction = submap_of_node_[parallel] == submap_of_node_[edge];
  return inverse(map_from_node_[edge]) * (is_same_direction ? move : inverse(move)) * map_from_node_[edge + 1];
}

}  // namespace shapemap
