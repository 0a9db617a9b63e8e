// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/mapper/mapper_options.hpp"

namespace shapemap {

void make_strict_paper(MappingOptions& options) {
  options.run.method = Method::kPaper;
  options.deskew.mode = Deskew::kOff;
  options.shape.points = ShapePoints::kBeams;
  options.align.histogram.norm = HistogramNorm::kCount;
  options.align.lcs.target = LcsTarget::kConcatenated;
  options.align.filters.main_segments = 1;
  options.align.overlap.rule = OverlapRule::kAny;
  options.align.icp.gate = IcpGate::kSlack;
  options.align.icp.decoupled_max_shift_m = 10.0;  // no limit: the largest values that the options allow
  options.align.icp.decoupled_max_turn_rad = kPi;
}

void validate_all(const MappingOptions& options) {
  MappingOptions::groups(options, [](const char*, const auto& group) { validate(group); });
}

}  // namespace shapemap
