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

/// These options decide how a mapper works while scans come in. None of them changes the result of Mapper::finish().
struct LiveOptions {
  /// Maps are published while the graph grows; otherwise only finish() makes one.
  bool publish = true;
  /// The graph is optimised in a thread of its own, so that add_scan() takes no longer than the match of a scan. The
  /// moments when maps are published then depend on time; the maps do not.
  bool in_background = false;
};

/// Makes a map of scans that are pushed into it one after the other, from their ranges alone.
///
/// Each scan has a pose at once. Whenever enough keyframes are new, loops are closed, a map is published, and
/// corrections_since() tells which scans have moved. finish() returns the map of all scans. It is the same to the bit
/// for any grouping of the scans into calls, for any number of threads, and with or without published maps.
///
/// Calls must come from one thread at a time, except for map() and corrections_since(), which may come from any.
class Mapper {
 public:
  /// Uses the robust method, whatever `options.run.method` is. `events` are told what happens, and asked whether to go
  /// on; `cache` keeps matches. Both may be null; the mapper keeps the pointers. Throws ConfigError for options out of
  /// their limits.
  explicit Mapper(const MappingOptions& options, const LiveOptions& live = {}, MappingEvents* events = nullptr,
                  MatchCache* cache = nullptr);
  ~Mapper();
  Mapper(const Mapper&) = delete;
  Mapper& operator=(const Mapper&) = delete;

  /// Adds the next scan. `session` is the number of the recording that it is from; the motion between two sessions is
  /// unknown. Throws InputError for a scan that no sensor can have recorded (scan/plausibility.hpp); the mapper then
  /// goes on without it. Throws std::logic_error after finish(), and after any other exception, such as that of a
  /// listener: it ends the mapper.
  ScanUpdate add_scan(const Scan& scan, std::size_t session = 0);

  /// Adds several scans of one session, which are worked on in parallel. The result is that of adding them one by one.
  std::vector<ScanUpdate> add_scans(const Scan* first, std::size_t count, std::size_t session = 0);

  /// Returns the latest map; null before the first.
  std::shared_ptr<const Map> map() const;

  /// Returns the scans that have another pose now than in the map of version `version`.
  Corrections corrections_since(MapVersion version) const;

  /// Returns the map of all scans. When the events ask to stop, no more loops are searched, and the map is made of what
  /// was found. Throws std::logic_error when it is called twice.
  MapResult finish();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace shapemap
