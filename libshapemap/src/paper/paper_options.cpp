// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/paper/paper_options.hpp"

namespace shapemap {

void validate_all(const PaperMapperOptions& options) {
  validate(options.returns);
  validate(options.polylines);
  validate(options.shape);
  PaperOptions::groups(options.method, [](const char*, const auto& group) { validate(group); });
}

void read_literally(PaperOptions& options) {
  options.histogram.norm = HistogramNorm::kCount;
  options.lcs.target = LcsTarget::kConcatenated;
  options.filters.main_segments = 1;
  options.overlap.rule = OverlapRule::kAny;
  options.icp.gate = IcpGate::kSlack;
  options.icp.decoupled_max_shift_m = 10.0;  // no limit: the largest values that the options allow
  options.icp.decoupled_max_turn_rad = kPi;
}

}  // namespace shapemap
