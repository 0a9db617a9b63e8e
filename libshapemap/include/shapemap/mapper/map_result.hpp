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

/// The result for one scan of the log, whether placed or not.
struct ScanResult {
  std::size_t scan_index = 0;
  double timestamp_s = 0.0;
  std::size_t session = 0;  ///< number of the recording that the scan is from
  int component = -1;       ///< index into MapResult::components; -1: the scan has no usable shape, and no component
  bool starts_component = false;
  ScanMatch match;  ///< match of the robust method to the scans before; meaningless for the first scan
  std::optional<PaperAlignment> paper;   ///< alignment of the paper's method, where there was something to align to
  std::size_t reference = kNoReference;  ///< the scan that `match` is to
  /// Loops constrain the pose of this scan, so that it is right even if the match was wrong.
  bool loop_constrained = false;
  bool is_keyframe = true;
  std::string reason;  ///< one line that says why the match is in doubt; empty when it is not

  /// The following functions summarise the result of either method. A scan was aligned unless there was nothing to
  /// align it to, as at the start of a session, or where the paper's method starts a component.
  bool was_aligned() const;
  bool is_without_shape() const;
  bool is_sure() const;
  bool has_pose() const;  ///< whether ref_from_query() is a pose
  Pose2 ref_from_query() const;
  std::string status_text() const;
  const std::string& alignment_reason() const;
};

/// The seconds spent per stage, summed over threads where a stage is threaded.
struct StageTimes {
  double shape_s = 0.0;
  double align_s = 0.0;
  double icp_s = 0.0;
  double decoupled_icp_s = 0.0;
  double loops_s = 0.0;        ///< loop detection and optimisation of the map
  double consistency_s = 0.0;  ///< consistency of each scan with the map
};

struct MapResult {
  std::vector<Component> components;  ///< components in the order of the log
  std::vector<ScanResult> scans;      ///< one result per scan that was worked on
  std::vector<ClosedLoop> loops;      ///< closed loops, strongest first
  int largest_component = -1;         ///< index of the component that makes the map; -1: none
  StageTimes times;
  bool interrupted = false;  ///< whether the observer asked to stop, so that the rest of the log was left out

  /// Returns the scans of the largest component; none when there is no component.
  const std::vector<PlacedScan>& placed() const;

  /// Returns one line that says why a scan is not in the map; empty for one that is.
  std::string why_not_in_map(const ScanResult& scan) const;
};

/// Returns the index of the first component with most scans; -1 where there is none.
int largest_component(const std::vector<Component>& components);

}  // namespace shapemap
