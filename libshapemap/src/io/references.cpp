// SPDX-License-Identifier: GPL-3.0-or-later
#include "references.hpp"

namespace shapemap {

std::vector<std::size_t> references_of(const MapResult& result) {
  std::vector<std::size_t> references;
  std::size_t keyframe = kNoReference;
  for (const ScanResult& scan : result.scans) {
    references.push_back(scan.reference == kNoReference ? keyframe : scan.reference);
    if (scan.component >= 0 && scan.is_keyframe) keyframe = scan.scan_index;
  }
  return references;
}

}  // namespace shapemap
