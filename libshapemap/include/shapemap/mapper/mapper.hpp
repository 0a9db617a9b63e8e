// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "shapemap/mapper/map.hpp"
#include "shapemap/mapper/map_result.hpp"
#include "shapemap/mapper/mapper_options.hpp"
#include "shapemap/mapper/mapping_events.hpp"
#include "shapemap/mapper/scan_update.hpp"
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

/// Makes a map of scans that are pushed into it one after the other, from their ranges alone.
///
/// Each scan has a pose at once. Maps follow while it grows: whenever enough is new, loops are closed, and
/// corrections_since() tells what has moved. finish() gives the map of all. It is the same to the bit however the scans
/// were grouped, for any number of threads, and with or without maps in between.
///
/// Calls must come from one thread at a time, but for map() and corrections_since(), which may come from any.
class Mapper {
 public:
  /// Uses the robust method, whatever `options.run.method` is. `events` hear what happens and are asked whether to go
  /// on; `cache` keeps matches. Both may be null; the mapper keeps the pointers. Throws ConfigError for options out of
  /// their limits.
  explicit Mapper(const MappingOptions& options, const LiveOptions& live = {}, MappingEvents* events = nullptr,
                  MatchCache* cache = nullptr);
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

  /// The map of all scans. When the events ask to stop, it is made with what was found by then.
  MapResult finish();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace shapemap
