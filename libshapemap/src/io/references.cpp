// SPDX-License-Identifier: GPL-3.0-or-later
#include "references.hpp"

namespace shapemap {

std::vector<std::size_t> references_of(const MapResult& result) {
  std::vector<std::size_t> references;
  std::size_t keyframe = kNoReference;
  for (const ScanResult& position : result.scans) {
    references.push_back(position.reference == kNoReference ? keyframe : position.reference);
    if (position.component >= 0 && position.is_keyframe) keyframe = position.scan_index;
  }
  return references;
}

}  // namespace shapemap
