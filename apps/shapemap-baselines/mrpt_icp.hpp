// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "shapemap/core/options.hpp"
#include "shapemap/scan/returns.hpp"
#include "slam_method.hpp"

namespace shapemap::baselines {

struct IcpOptions {
  double reach_m = 0.3;
  double insertion_m = 1.2;
  double insertion_rad = 45 * kDegree;
  double min_goodness = 0.40;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"icp-reach-m", "points farther apart are no pair at first [m]", 0.05, 100}, self.reach_m);
    visit(Field{"icp-insertion-m", "scans enter the map that are so far from the latest in it [m]; 0: all", 0, 100},
          self.insertion_m);
    visit(Field{"icp-insertion-deg", "the same of the heading [deg]", 0, 180, kDegree}, self.insertion_rad);
    visit(Field{"icp-min-goodness", "share of paired points below which odometry is believed instead", 0, 1},
          self.min_goodness);
  }
};

/// MRPT's CMetricMapBuilderICP matches each scan by ICP with a map of the points of the scans before it.
std::unique_ptr<SlamMethod> make_mrpt_icp(const IcpOptions& options, const ReturnOptions& returns);

}  // namespace shapemap::baselines
