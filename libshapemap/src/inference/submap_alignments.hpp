// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/graph/edge.hpp"

/// Ways to lay two pieces of a map together, each with a frame of its own.
namespace shapemap {

/// The submap `f` and the submap `g` in one frame, and the candidates that say so.
struct SubmapAlignment {
  Pose2 f_from_g;
  std::vector<std::size_t> joints;  ///< indices of these candidates
  double gain = 0.0;
};

/// What is known of how the submaps of a graph lie to each other.
struct SubmapGraph {
  /// Candidates of edges between nodes of one or of two submaps; the score of each is what it is worth, and limited.
  const std::vector<EdgeCandidate>& joints;
  const std::vector<Pose2>& submap_from_node;      ///< each node in the frame of its submap
  const std::vector<std::size_t>& submap_of_node;  ///< by number
};

/// Finds the ways to lay two submaps together. What all candidates between two submaps are worth together is at most
/// `trust_cap`.
class SubmapAlignments {
 public:
  SubmapAlignments(const SubmapGraph& graph, double trust_cap)
      : joints_(graph.joints),
        submap_from_node_(graph.submap_from_node),
        submap_of_node_(graph.submap_of_node),
        trust_cap_(trust_cap) {}

  /// Returns what some of `between`, the candidates between `f` and another submap, agree on; what the best of them say
  /// comes first, and there are no more than can be right. An alignment that starts from a candidate gains what
  /// `noise` has for it; an empty one has nothing.
  std::vector<SubmapAlignment> ways(std::size_t f, const std::vector<std::size_t>& between,
                                    const std::vector<double>& noise = {}) const;

  /// Says whether a candidate within a submap agrees with it.
  bool holds(const EdgeCandidate& joint) const;

 private:
  /// A joint as from piece `f` to the other.
  struct Seen {
    std::size_t joint;
    std::size_t a;  ///< in `f`
    std::size_t b;
    Pose2 f_from_b;  ///< by the joint
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

/// Where the chain goes from one piece to the other and back: nodes of both, `of_f` and `of_g`, in order.
struct Crossing {
  std::size_t in_f;
  std::size_t in_g;
  std::size_t num_steps;
};
std::vector<Crossing> crossings(const std::vector<std::size_t>& of_f, const std::vector<std::size_t>& of_g);

}  // namespace shapemap
