// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "shapemap/core/options.hpp"
#include "shapemap/scan/returns.hpp"
#include "slam_method.hpp"

namespace shapemap::baselines {

struct VascoOptions {
  int local_scans = 20;
  double longest_beam_m = 20.0;
  double cell_m = 0.05;
  double finest_sigma_m = 0.05;
  int levels = 5;
  int halvings = 4;
  double lever_m = 3.0;
  double floor = 0.1;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"local-scans", "latest scans that make the local map", 1, 1000}, self.local_scans);
    visit(Field{"vasco-longest-beam-m", "longer beams are not used [m]", 1, 50}, self.longest_beam_m);
    visit(Field{"vasco-cell-m", "side of a cell of the local map [m]", 0.02, 1}, self.cell_m);
    visit(Field{"finest-sigma-m", "smoothing of the finest likelihood field; each coarser one has twice that [m]", 0.02,
                1},
          self.finest_sigma_m);
    visit(Field{"levels", "likelihood fields, climbed from coarse to fine", 1, 8}, self.levels);
    visit(Field{"halvings", "halvings of the steps on each field; the first step is the field's smoothing", 0, 20},
          self.halvings);
    visit(Field{"lever-m", "a turn counts as the step that it makes so far away [m]", 0.1, 100}, self.lever_m);
    visit(Field{"likelihood-floor", "likelihood of a beam that ends where nothing was, 1 being a sure wall", 1e-6, 1},
          self.floor);
  }
};

/// Maximum likelihood, scan by scan, in the manner of CARMEN's vasco: the pose is the one that makes the scan most
/// likely given the map of the latest scans and the motion. See D. Haehnel, D. Schulz, W. Burgard, "Map building with
/// mobile robots in populated environments", IROS 2002, and S. Thrun, W. Burgard, D. Fox, "A real-time algorithm for
/// mobile robot mapping", ICRA 2000.
std::unique_ptr<SlamMethod> make_vasco(const VascoOptions& options, const ReturnOptions& returns);

}  // namespace shapemap::baselines
