// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "shapemap/paper/paper_alignment.hpp"
#include "shapemap/paper/paper_options.hpp"
#include "shapemap/paper/partial_map.hpp"

/// Paper, sections II-C to V-A: the pose of a query scan in a partial map, by shape and then by ICP.
namespace shapemap {

/// How one alignment is run. None of this is an option of the method.
struct PaperRun {
  int threads = 1;                             ///< the result does not depend on it; 0: one per processor
  int min_points = ShapeOptions().min_points;  ///< fewer shape points, of the query or the target, are not aligned
  /// This is asked before each rotation and step, if given, from the thread that aligns; false ends the alignment with
  /// Interrupted.
  std::function<bool()> keep_going{};
};

/// The rotations to try: multiples of the step within the range, ascending; a full turn has no angle twice.
std::vector<double> rotation_grid(const RotationOptions& options);

/// Aligns `query` to `target`, starting from the same heading. It never throws for scans that do not match:
/// PaperAlignment::status says so. `trace`, if given, receives everything that led to the result.
PaperAlignment paper_align(const PartialMap& target, const Shape& query, const PaperOptions& options,
                           const PaperRun& run = {}, PaperTrace* trace = nullptr);

/// Aligns to a single scan.
PaperAlignment paper_align(const Shape& reference, const Shape& query, const PaperOptions& options,
                           const PaperRun& run = {}, PaperTrace* trace = nullptr);

}  // namespace shapemap
