// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "shapemap/core/options.hpp"
#include "shapemap/scan/scan.hpp"

namespace shapemap {

/// Selects scans of a log: `skip` are left out, then every `every`-th counts, then `first` of those.
struct SelectionOptions {
  int first = 0;
  int skip = 0;
  int every = 1;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"first", "use only so many positions; 0: all", 0, 2147483647}, self.first);
    visit(Field{"skip", "leave out so many positions at the start", 0, 2147483647}, self.skip);
    visit(Field{"every", "use every n-th position of the rest", 1, 2147483647}, self.every);
  }
};

/// Returns the log with the selected scans only. Throws ConfigError when that leaves none of a log that has some.
Log select_scans(Log log, const SelectionOptions& options);

/// Returns the index in the whole log of the selected scan `index`.
std::size_t index_in_whole_log(std::size_t index, const SelectionOptions& options);

}  // namespace shapemap
