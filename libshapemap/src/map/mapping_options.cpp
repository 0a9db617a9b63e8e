// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/map/mapping_options.hpp"

namespace shapemap {

void make_strict_paper(MappingOptions& options) {
  options.shape.points = ShapePoints::kBeams;
  options.align.histogram.norm = HistogramNorm::kCount;
  options.align.lcs.target = LcsTarget::kConcatenated;
  options.align.filters.main_segments = 1;
  options.align.overlap.rule = OverlapRule::kAny;
  options.align.icp.gate = IcpGate::kSlack;
}

void validate_all(const MappingOptions& options) {
  MappingOptions::groups(options, [](const char*, const auto& group) { validate(group); });
}

}  // namespace shapemap
