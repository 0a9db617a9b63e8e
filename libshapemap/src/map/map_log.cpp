// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/map/map_log.hpp"

namespace shapemap {

MapResult map_log(const Log&, const MappingOptions& options, RunObserver&) {
  validate_all(options);
  return {};
}

}  // namespace shapemap
