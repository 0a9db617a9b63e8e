// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "shapemap/core/options.hpp"
#include "shapemap/scan/returns.hpp"
#include "slam_method.hpp"

namespace shapemap::baselines {

struct IcpOptions {
  double insertion_m = 0.0;
  double insertion_rad = 0.0;
  double min_goodness = 0.40;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"icp-insertion-m", "scans enter the map that are so far from the latest in it [m]; 0: all", 0, 100},
          self.insertion_m);
    visit(Field{"icp-insertion-deg", "the same of the heading [deg]", 0, 180, kDegree}, self.insertion_rad);
    visit(Field{"icp-min-goodness", "share of paired points below which odometry is believed instead", 0, 1},
          self.min_goodness);
  }
};

/// MRPT's CMetricMapBuilderICP: each scan is aligned by ICP to a map of the points of the scans before it.
std::unique_ptr<SlamMethod> make_mrpt_icp(const IcpOptions& options, const ReturnOptions& returns);

}  // namespace shapemap::baselines
