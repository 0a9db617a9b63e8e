// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/graph/pose_graph.hpp"

/// Ways to lay two pieces of a map together, each with a frame of its own.
namespace shapemap {

/// An alignment of two scans that may be right.
struct SubmapCandidate {
  PoseConstraint constraint;
  double worth = 0.0;  ///< logarithm of odds, limited
  double noise = 0.0;  ///< what a way gains that starts from it
};

/// The piece `f` and the piece `g` in one frame, and the joints that say so.
struct SubmapAlignment {
  Pose2 f_from_g;
  std::vector<std::size_t> joints;
  double gain = 0.0;
};

/// Joints by index, poses by node, each in the frame of its piece. What all joints of two pieces are worth together is
/// at most `trust_cap`.
class SubmapAlignments {
 public:
  SubmapAlignments(const std::vector<SubmapCandidate>& joints, const std::vector<Pose2>& submap_from_node,
                   const std::vector<std::size_t>& submap_of_node, double trust_cap)
      : joints_(joints), submap_from_node_(submap_from_node), submap_of_node_(submap_of_node), trust_cap_(trust_cap) {}

  /// What some of `between`, the joints of `f` and another piece, agree on; those of the best joints first, and no more
  /// than can be right.
  std::vector<SubmapAlignment> ways(std::size_t f, const std::vector<std::size_t>& between) const;

  /// Whether a joint within a piece agrees with it.
  bool holds(const SubmapCandidate& joint) const;

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

  const std::vector<SubmapCandidate>& joints_;
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
