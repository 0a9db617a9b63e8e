// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/mapper/map_result.hpp"

#include <algorithm>

namespace shapemap {

bool ScanResult::was_aligned() const { return paper || match.status != MatchStatus::kNoShape || !reason.empty(); }

bool ScanResult::is_without_shape() const {
  return paper ? paper->status == PaperStatus::kNoShape : match.status == MatchStatus::kNoShape;
}

bool ScanResult::is_sure() const { return paper ? paper->ok() : match.ok(); }

bool ScanResult::has_pose() const { return paper ? paper->ok() : match.has_pose(); }

Pose2 ScanResult::ref_from_query() const { return paper ? paper->ref_from_query : match.ref_from_query; }

std::string ScanResult::status_text() const { return paper ? enum_name(paper->status) : enum_name(match.status); }

const std::string& ScanResult::alignment_reason() const { return paper ? paper->reason : match.reason; }

const std::vector<PlacedScan>& MapResult::placed() const {
  static const std::vector<PlacedScan> none;
  return largest_component < 0 ? none : components[static_cast<std::size_t>(largest_component)].scans;
}

std::string MapResult::why_not_in_map(const ScanResult& scan) const {
  if (scan.component < 0) return scan.reason;
  if (scan.component == largest_component) return "";
  return scan.reason + (scan.reason.empty() ? "" : "; ") + "in fragment " + std::to_string(scan.component) +
         ", which nothing ties to the map";
}

int largest_component(const std::vector<Component>& components) {
  const auto fewer = [](const Component& a, const Component& b) { return a.scans.size() < b.scans.size(); };
  const auto found = std::max_element(components.begin(), components.end(), fewer);
  return found == components.end() ? -1 : static_cast<int>(found - components.begin());
}

}  // namespace shapemap
