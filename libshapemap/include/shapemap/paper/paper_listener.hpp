// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/paper/paper_alignment.hpp"
#include "shapemap/shape/shape.hpp"

/// How a caller sees the steps of the paper, sections II to V-A, while a PaperMapper takes them: for figures and
/// analyses.
namespace shapemap {

/// One of the scans that make a partial map. Its points are those of its own shape, corrected and moved.
struct TracedTarget {
  std::size_t scan_index = 0;
  std::size_t num_points = 0;
  Pose2 ref_from_robot;
  std::vector<Pose2> robot_from_sweep;
};

/// An alignment to a partial map, of which the last target is the reference.
struct TracedAlignment {
  std::size_t query_index = 0;
  std::vector<TracedTarget> targets;
  const PaperAlignment& alignment;
  const PaperTrace& steps;
};

/// Calls come from the thread that pushes scans, in the order of the scans, and what they refer to is gone afterwards.
/// A listener changes no result; what it throws ends the call that it listens to.
struct PaperListener {
  virtual ~PaperListener() = default;
  /// All points that the method looks at of a scan, in the robot's frame.
  virtual void on_shape(std::size_t /*scan_index*/, const std::vector<ShapePoint>& /*points*/) {}
  virtual void on_alignment(const TracedAlignment& /*alignment*/) {}
};

}  // namespace shapemap
