// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "shapemap/core/pose2.hpp"

namespace shapemap {

/// What node i + 1 may be to node i.
struct EdgeChoices {
  struct Candidate {
    Pose2 a_from_b;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
    double score = 0.0;  ///< logarithm of odds, up to a constant that the alternatives of a link share
  };
  std::vector<Candidate> candidates;  ///< the best first; none: the two nodes belong to different pieces
  double probability = 0.0;           ///< that the first alternative is right
  double any_probability = 0.0;       ///< that one of them is, by how well the best fits

  bool exists() const { return !candidates.empty(); }
};

/// The first alternatives of the links that tell how the robot usually moves: nine of ten of them at least are right.
std::vector<Pose2> sure_steps(const std::vector<EdgeChoices>& edges);

}  // namespace shapemap
