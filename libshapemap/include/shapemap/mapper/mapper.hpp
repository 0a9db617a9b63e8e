// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "shapemap/core/observer.hpp"
#include "shapemap/mapper/map.hpp"
#include "shapemap/mapper/map_result.hpp"
#include "shapemap/mapper/mapper_options.hpp"
#include "shapemap/mapper/trace_sink.hpp"
#include "shapemap/matching/match_cache.hpp"
#include "shapemap/scan/scan.hpp"

namespace shapemap {

/// How a mapper works while scans come in. None of it changes the result of Mapper::finish().
struct LiveOptions {
  /// Maps are made while the graph grows; without, only finish() makes one.
  bool publish = true;
  /// The graph is solved in a thread of its own, so that add_scan() takes no longer than it takes to match a scan. When
  /// maps are published then depends on time; which ones does not.
  bool in_background = false;
};

/// What a scan is to the map.
enum class ScanRole {
  kKeyframe,  ///< others are matched to it
  kAttached,  ///< a keyframe shows the same
  kNoShape,   ///< it has too few points that tell anything, and no pose
};

/// What is known of a scan as soon as it has come.
struct ScanUpdate {
  std::size_t scan = 0;  ///< its number, from 0 on in the order in which scans come
  ScanRole role = ScanRole::kNoShape;
  /// Where it is in the map of `version`, by way of the matches since. Without a component where nothing joins it to
  /// that map; before the first map, component 0 is what matches join to the first scan with shape.
  ScanPose pose;
  MapVersion version = 0;

  std::size_t reference = kNoReference;  ///< the keyframe that it was matched to; none for the first of a session
  Pose2 reference_from_robot = kNoPose;  ///< by that match
  double probability = 0.0;              ///< that the match is right, by these two scans
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (x, y, theta) of `reference_from_robot`
};

/// Makes a map of scans that are pushed into it one after the other, from their ranges alone.
///
/// Each scan has a pose at once. Maps follow while it grows: whenever enough is new, loops are closed, and
/// corrections_since() tells what has moved. finish() gives the map of all. It is the same to the bit however the scans
/// were grouped, for any number of threads, and with or without maps in between.
///
/// Calls must come from one thread at a time, but for map() and corrections_since(), which may come from any.
class Mapper {
 public:
  /// Uses the robust method, whatever `options.run.method` is. `observer` hears of the stages of the work and is asked
  /// whether to go on; with LiveOptions::in_background it hears only of what finish() does. `sink` sees what leads to
  /// the map, in the background from another thread, though never two calls at a time. `cache` keeps matches. All three
  /// may be null; the mapper keeps the pointers. Throws ConfigError for options out of their limits.
  explicit Mapper(const MappingOptions& options, const LiveOptions& live = {}, RunObserver* observer = nullptr,
                  TraceSink* sink = nullptr, MatchCache* cache = nullptr);
  ~Mapper();
  Mapper(const Mapper&) = delete;
  Mapper& operator=(const Mapper&) = delete;

  /// Adds the next scan. `session` is the number of the recording that it is from: nothing is known of the motion
  /// between two sessions. Throws InputError for a scan that no sensor can have recorded (scan/plausibility.hpp), and
  /// std::logic_error after finish().
  ScanUpdate add_scan(const Scan& scan, std::size_t session = 0);

  /// Adds several scans of one session, which are worked on in parallel. The result is that of adding one by one.
  std::vector<ScanUpdate> add_scans(const Scan* first, std::size_t count, std::size_t session = 0);

  /// The latest map; null before the first.
  std::shared_ptr<const Map> map() const;

  /// The scans that have another pose now than in the map of version `version`.
  Corrections corrections_since(MapVersion version) const;

  /// The map of all scans. When the observer asks to stop, it is made with what was found by then.
  MapResult finish();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace shapemap
