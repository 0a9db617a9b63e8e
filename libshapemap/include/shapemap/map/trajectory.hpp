// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "shapemap/align/alignment.hpp"
#include "shapemap/core/pose2.hpp"

namespace shapemap {

/// What became of the beams of a scan that returned, in the map that the scans from elsewhere make; as shares of them.
struct ScanAgreement {
  double agree = 0.0;            ///< end on a surface that others saw
  double through = 0.0;          ///< went through a surface that others saw, and on
  double in_free = 0.0;          ///< end where others looked through
  bool contradicts_map = false;  ///< too many of the last two among what is known

  /// The rest ends where nobody else has looked.
  double known() const { return agree + through + in_free; }
};

/// One position of the log with a pose.
struct PlacedPosition {
  std::size_t position_index = 0;  ///< into Log::positions
  double timestamp_s = 0.0;
  Pose2 map_from_robot;
  /// Small corrections of each sub-scan found by decoupled ICP: pose of the sub-scan's robot frame in the
  /// position's robot frame. One per sub-scan of the position.
  std::vector<Pose2> robot_from_sub_scan;
  ScanAgreement agreement{};  ///< with the rest of the fragment; see scan_agreement.hpp
};

/// Positions that are connected by trusted alignments; poses are relative to its first position.
struct Fragment {
  std::vector<PlacedPosition> positions;
};

inline constexpr std::size_t kNoReference = static_cast<std::size_t>(-1);

/// What became of one position of the log, whether placed or not.
struct PositionResult {
  std::size_t position_index = 0;
  double timestamp_s = 0.0;
  int fragment = -1;  ///< index into MapResult::fragments; -1: no usable shape, in no fragment
  bool starts_fragment = false;
  Alignment alignment;                   ///< against the scans before it; meaningless for the first position
  std::size_t reference = kNoReference;  ///< the position that it is to, where that is not the last keyframe before it
  /// Loops hold this position where it is, even if that alignment was wrong.
  bool held_by_loops = false;
  bool is_keyframe = true;
  std::string reason;  ///< empty when aligned without doubt; else one line that says why not
};

/// Two places that are known to be near each other though the log came to them at different times.
struct ClosedLoop {
  std::size_t a = 0;  ///< index of a position; the earlier one
  std::size_t b = 0;
  Pose2 a_from_b;         ///< of the best of the alignments behind it
  double strength = 0.0;  ///< log odds of these, summed
};

/// Seconds spent per stage, summed over threads where a stage is threaded.
struct StageTimes {
  double shape_s = 0.0;
  double align_s = 0.0;
  double icp_s = 0.0;
  double decoupled_icp_s = 0.0;
  double loops_s = 0.0;      ///< to know places again, and to solve for the map
  double agreement_s = 0.0;  ///< to see how each scan goes with the rest
};

struct MapResult {
  std::vector<Fragment> fragments;        ///< in the order of the log
  std::vector<PositionResult> positions;  ///< one per position of the log that was looked at
  std::vector<ClosedLoop> loops;          ///< strongest first
  int largest_fragment = -1;              ///< the fragment that makes the map; -1: none
  StageTimes times;
  bool interrupted = false;  ///< the observer asked to stop; the rest of the log was not looked at

  /// Positions of the largest fragment; empty when there is none.
  const std::vector<PlacedPosition>& placed() const;

  /// One line that says why a position is not in the map; empty for one that is.
  std::string why_not_in_map(const PositionResult& position) const;
};

}  // namespace shapemap
