// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/graph/edge.hpp"

/// These functions find the relative poses that candidates give two submaps.
namespace shapemap {

/// A relative pose of two submaps, and the candidates that agree on it.
struct SubmapAlignment {
  Pose2 f_from_g;
  std::vector<std::size_t> joints;  ///< indices of these candidates
  double gain = 0.0;
};

/// The submaps of a graph, and the candidates between their nodes.
struct SubmapGraph {
  /// The candidates are between nodes of one or of two submaps. The score of each is its worth, which is limited.
  const std::vector<EdgeCandidate>& joints;
  const std::vector<Pose2>& submap_from_node;      ///< each node in the frame of its submap
  const std::vector<std::size_t>& submap_of_node;  ///< number of the submap of each node
};

/// Finds the relative poses of two submaps. All candidates between two submaps together are worth at most `trust_cap`.
class SubmapAlignments {
 public:
  SubmapAlignments(const SubmapGraph& graph, double trust_cap)
      : joints_(graph.joints),
        submap_from_node_(graph.submap_from_node),
        submap_of_node_(graph.submap_of_node),
        trust_cap_(trust_cap) {}

  /// Returns the relative poses on which candidates in `between` agree. These lie between `f` and another submap. The
  /// pose of the best candidate comes first, and there are no more poses than can be right. A pose that starts from a
  /// candidate gains the `noise` of that candidate, if there is any noise.
  std::vector<SubmapAlignment> ways(std::size_t f, const std::vector<std::size_t>& between,
                                    const std::vector<double>& noise = {}) const;

  /// Says whether a candidate within one submap agrees with it.
  bool holds(const EdgeCandidate& joint) const;

 private:
  /// A candidate, seen from submap `f`.
  struct Seen {
    std::size_t joint;
    std::size_t a;  ///< the node in `f`
    std::size_t b;
    Pose2 f_from_b;  ///< by the candidate
    Pose2 g_from_b;
    double worth;
  };
  Seen seen_from(std::size_t f, std::size_t joint) const;
  static bool agree(const Pose2& f_from_g, const Seen& one, const Seen& seed);
  static Pose2 mean_of(const std::vector<Seen>& joints);
  double strength(const std::vector<Seen>& joints) const;

  const std::vector<EdgeCandidate>& joints_;
  const std::vector<Pose2>& submap_from_node_;
  const std::vector<std::size_t>& submap_of_node_;
  double trust_cap_;
};

/// A place where the trajectory goes from one of two submaps to the other, in either direction.
struct Crossing {
  std::size_t in_f;
  std::size_t in_g;
  std::size_t num_steps;
};
/// Returns the crossings between two submaps. `of_f` and `of_g` are their nodes, in order.
std::vector<Crossing> crossings(const std::vector<std::size_t>& of_f, const std::vector<std::size_t>& of_g);

}  // namespace shapemap
