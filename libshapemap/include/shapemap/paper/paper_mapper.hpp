// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "shapemap/core/execution.hpp"
#include "shapemap/paper/paper_align.hpp"
#include "shapemap/paper/paper_listener.hpp"
#include "shapemap/paper/partial_map.hpp"
#include "shapemap/scan/placed_scan.hpp"
#include "shapemap/scan/scan.hpp"

/// Paper, sections II-C and IV: the global map, for which each scan is aligned to a partial map of the few before it.
namespace shapemap {

/// What became of one scan.
struct PaperScanResult {
  std::size_t scan_index = 0;  ///< how many scans were pushed before it
  double timestamp_s = 0.0;
  int component = -1;  ///< index into PaperMapResult::components; -1: the scan has no usable shape
  bool starts_component = false;
  /// To the partial map of the scans before it. A scan that has shape but nothing to be aligned to has none: the first
  /// one, and one after a scan without shape.
  std::optional<PaperAlignment> alignment;

  std::optional<PaperStatus> status() const {
    return alignment ? std::optional<PaperStatus>(alignment->status) : std::nullopt;
  }
  /// One line that says why the scan is not aligned; empty where it is, or where there is nothing to align it to.
  std::string reason() const { return alignment ? alignment->reason : std::string(); }
};

struct PaperMapResult {
  std::vector<Component> components;   ///< in the order of the scans
  std::vector<PaperScanResult> scans;  ///< one for each scan that was pushed
  double shape_s = 0.0;                ///< seconds that the shapes of all scans took
};

/// Places scans that are pushed one by one. A scan that cannot be aligned starts a new component.
class PaperMapper {
 public:
  /// The observer is asked between the steps of each alignment; it and `listener`, which may be null, must outlive the
  /// mapper. Throws ConfigError for an option that is out of its limits.
  PaperMapper(PaperMapperOptions options, const Execution& execution, PaperListener* listener = nullptr);

  /// Never throws for a scan that does not match. Throws InputError for a scan that no sensor can have recorded
  /// (scan/plausibility.hpp), and Interrupted when the observer asks to stop; the result is then as if the scan had
  /// never been pushed, but for a listener that has seen its shape.
  const PaperScanResult& add_scan(const Scan& scan);

  const PaperMapResult& result() const& { return result_; }
  PaperMapResult result() && { return std::move(result_); }

 private:
  /// A placed scan that later ones are aligned to.
  struct RecentScan {
    PlacedScan placed;
    TargetScan scan;  ///< in the robot's frame, with the corrections of its sweeps
  };

  PaperAlignment aligned(const Shape& shape) const;
  void place(const Scan& scan, const Shape& shape, PaperScanResult& outcome);
  Pose2 ref_from_robot(const RecentScan& recent) const;
  PartialMap target() const;

  PaperMapperOptions options_;
  Execution execution_;
  PaperListener* listener_;
  std::deque<RecentScan> recent_;
  PaperMapResult result_;
};

}  // namespace shapemap
