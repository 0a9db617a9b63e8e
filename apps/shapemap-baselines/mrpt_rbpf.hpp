// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "shapemap/core/options.hpp"
#include "slam_method.hpp"

namespace shapemap::baselines {

struct RbpfOptions {
  int particles = 25;
  int samples = 400;
  double cell_m = 0.07;
  double longest_beam_m = 35.0;
  double update_m = 0.25;
  double update_rad = 10 * kDegree;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"particles", "particles of the filter", 1, 10000}, self.particles);
    visit(Field{"samples", "motions that are tried for each particle", 1, 1000000}, self.samples);
    visit(Field{"rbpf-cell-m", "side of a cell of the particles' maps [m]", 0.01, 1}, self.cell_m);
    visit(Field{"rbpf-longest-beam-m", "longer beams enter no map [m]", 1, 1000}, self.longest_beam_m);
    visit(Field{"rbpf-update-m",
                "scans that odometry puts nearer to the last one used, for certain, are passed over [m]", 0, 100},
          self.update_m);
    visit(Field{"rbpf-update-deg", "unless they are turned by more [deg]", 0, 180, kDegree}, self.update_rad);
  }
};

/// MRPT's CMetricMapBuilderRBPF has particles that are whole trajectories with a grid map each; each particle samples
/// the motions that make its scan likely. The covariances of the motions are its motion model. Scans of nearly the same
/// place are skipped where motions are certain: many in a row make the filter too sure of itself, and take long. A
/// skipped scan is where its motion leads from the last scan that was not. MRPT's random numbers, which are global,
/// begin anew with `seed`.
std::unique_ptr<SlamMethod> make_mrpt_rbpf(const RbpfOptions& options, int seed);

}  // namespace shapemap::baselines
