// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/mapper/mapper_options.hpp"

namespace shapemap {

void make_strict_paper(MappingOptions& options) {
  options.run.method = Method::kPaper;
  options.deskew.mode = Deskew::kOff;
  options.shape.points = ShapePoints::kBeams;
  read_literally(options.paper);
}

void validate_all(const MappingOptions& options) {
  MappingOptions::groups(options, [](const char*, const auto& group) { validate(group); });
}

}  // namespace shapemap
