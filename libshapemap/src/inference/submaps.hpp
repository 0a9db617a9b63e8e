// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/core/pose2.hpp"

namespace shapemap {

/// The submaps of a map, each right in itself, in one frame. Edge i joins node i to node i + 1.
class Submaps {
 public:
  Submaps(std::vector<Pose2> map_from_node, std::vector<std::size_t> submap_of_node)
      : map_from_node_(std::move(map_from_node)), submap_of_node_(std::move(submap_of_node)) {}

  const std::vector<Pose2>& map_from_node() const { return map_from_node_; }
  const std::vector<std::size_t>& submap_of_node() const { return submap_of_node_; }

  bool is_joined(std::size_t edge) const { return submap_of_node_[edge] == submap_of_node_[edge + 1]; }

  /// Returns the present pose of node i + 1 relative to node i.
  Pose2 step(std::size_t edge) const { return inverse(map_from_node_[edge]) * map_from_node_[edge + 1]; }

  /// Returns the motion of the submap of the later node if the edge is `a_from_b`.
  Pose2 moved_by(std::size_t edge, const Pose2& a_from_b) const;

  /// Moves the submap of the later node, and gives it the number of the other submap.
  void join(std::size_t edge, const Pose2& a_from_b);

  /// Says whether both edges join the same two submaps, in either direction.
  bool are_parallel(std::size_t edge, std::size_t other) const;

  /// Returns the relative pose at `edge` if the `parallel` edge is `a_from_b`.
  Pose2 carried_to(std::size_t edge, std::size_t parallel, const Pose2& a_from_b) const;

 private:
  std::vector<Pose2> map_from_node_;
  std::vector<std::size_t> submap_of_node_;
};

}  // namespace shapemap
