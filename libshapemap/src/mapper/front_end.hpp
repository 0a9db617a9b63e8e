// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "graph/keyframe_graph.hpp"
#include "scan_tracker.hpp"
#include "shapemap/mapper/map_result.hpp"
#include "shapemap/mapper/mapper_options.hpp"
#include "shapemap/matching/match_cache.hpp"
#include "shapemap/scan/scan.hpp"

namespace shapemap {

/// A scan, and the number of the recording that it is from. It is used during the call only.
struct IncomingScan {
  const Scan& scan;
  std::size_t session = 0;
};

/// A new keyframe with its edge.
struct NewKeyframe {
  Keyframe keyframe;
  OdometryEdge edge;  ///< edge from the keyframe before; it has no candidates at the start of a session
};

/// The result of the front end for a scan. A scan with too few points of shape is neither attached nor a keyframe.
struct TrackedScan {
  std::size_t scan_index = 0;
  std::size_t session = 0;
  double timestamp_s = 0.0;
  std::size_t num_sweeps = 0;
  std::shared_ptr<const ScanView> view;
  std::optional<MatchCandidate> attached;  ///< its pose in the frame of the last keyframe, which can replace it
  std::optional<NewKeyframe> keyframe;
};

/// Matches each scan to the keyframe before it, with several candidates, and with multi-reference candidates where
/// these are in doubt. The result depends on this scan and the scans before it, and not on the map, so that the front
/// end can run ahead of the back end.
class FrontEnd {
 public:
  /// `cache` may be null. Keeps references to both.
  FrontEnd(const MappingOptions& options, MatchCache* cache);

  /// Returns one entry for each of `scans`, in their order. The scans of one call are worked on in parallel; the
  /// grouping into calls does not change the result. Scans are numbered from 0 in the order of calls.
  std::vector<TrackedScan> track(const std::vector<IncomingScan>& scans);

  std::size_t num_scans() const { return num_scans_; }
  double shape_s() const { return shape_s_; }  ///< time spent on views so far, summed over threads
  double match_s() const { return match_s_; }  ///< time spent on matching so far, summed over threads

 private:
  /// A keyframe that later ones are matched to.
  struct RecentKeyframe {
    std::size_t scan_index = 0;
    std::size_t session = 0;
    std::shared_ptr<const ScanView> view;
    std::vector<MatchCandidate> candidates;  ///< candidates of the edge from the keyframe before
    std::optional<Pose2> best_own;           ///< best pose in the frame of the keyframe before, by these two alone
  };

  double timed_for(std::size_t count, const std::function<void(std::size_t)>& work) const;
  std::shared_ptr<const ScanView> view(const Scan& scan) const;
  TrackedScan viewed(const IncomingScan& incoming, std::size_t scan_index) const;
  std::vector<std::shared_ptr<const ScanView>> views_of_sweeps(const Scan& scan) const;
  void track(TrackedScan& scan);
  void add_edges(std::size_t first, std::vector<NewKeyframe*>& added);
  bool has_edge(std::size_t recent) const;
  void finish_edge(std::size_t recent, const std::vector<MatchCandidate>& multi_reference, NewKeyframe& added);
  std::vector<MatchCandidate> matched(std::size_t reference, std::size_t query, SearchKind search,
                                      const MatchSearchOptions& options) const;
  std::vector<MatchCandidate> multi_reference_candidates(std::size_t recent) const;

  const MappingOptions& options_;
  MatchCache* cache_;
  ScanTracker tracker_;
  std::size_t num_scans_ = 0;
  std::size_t last_with_shape_ = 0;
  std::vector<RecentKeyframe> recent_;  ///< the last few keyframes, and those of the current call
  double shape_s_ = 0.0;
  double match_s_ = 0.0;
};

}  // namespace shapemap
