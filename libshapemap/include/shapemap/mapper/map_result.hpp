// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "shapemap/graph/closed_loop.hpp"
#include "shapemap/matching/scan_match.hpp"
#include "shapemap/paper/paper_alignment.hpp"
#include "shapemap/scan/placed_scan.hpp"

namespace shapemap {

inline constexpr std::size_t kNoReference = static_cast<std::size_t>(-1);

/// What became of one position of the log, whether placed or not.
struct ScanResult {
  std::size_t scan_index = 0;
  double timestamp_s = 0.0;
  std::size_t session = 0;  ///< the recording that it is from
  int component = -1;       ///< index into MapResult::fragments; -1: no usable shape, in no fragment
  bool starts_component = false;
  ScanMatch match;  ///< by the robust method, to the scans before it; meaningless for the first position
  std::optional<PaperAlignment> paper;   ///< by the paper's method, where there was something to align it to
  std::size_t reference = kNoReference;  ///< the position that it is to, where that is not the last keyframe before it
  /// Loops hold this position where it is, even if that alignment was wrong.
  bool loop_constrained = false;
  bool is_keyframe = true;
  std::string reason;  ///< empty when aligned without doubt; else one line that says why not

  /// What either method says of the scan. It was aligned unless there was nothing to align it to: at the start of a
  /// log, or where the paper's method starts anew.
  bool was_aligned() const;
  bool is_without_shape() const;
  bool is_sure() const;
  bool has_pose() const;  ///< of the scan in the frame of its reference
  Pose2 ref_from_query() const;
  std::string status_text() const;
  const std::string& alignment_reason() const;
};

/// Seconds spent per stage, summed over threads where a stage is threaded.
struct StageTimes {
  double shape_s = 0.0;
  double align_s = 0.0;
  double icp_s = 0.0;
  double decoupled_icp_s = 0.0;
  double loops_s = 0.0;        ///< to know places again, and to solve for the map
  double consistency_s = 0.0;  ///< to see how each scan goes with the rest
};

struct MapResult {
  std::vector<Component> components;  ///< in the order of the log
  std::vector<ScanResult> scans;      ///< one per position of the log that was looked at
  std::vector<ClosedLoop> loops;      ///< strongest first
  int largest_component = -1;         ///< the fragment that makes the map; -1: none
  StageTimes times;
  bool interrupted = false;  ///< the observer asked to stop; the rest of the log was not looked at

  /// Positions of the largest fragment; empty when there is none.
  const std::vector<PlacedScan>& placed() const;

  /// One line that says why a position is not in the map; empty for one that is.
  std::string why_not_in_map(const ScanResult& scan) const;
};

/// Returns the index of the first of the components with most scans; -1 where there is none.
int largest_component(const std::vector<Component>& components);

}  // namespace shapemap
