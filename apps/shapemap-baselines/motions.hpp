// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "shapemap/core/options.hpp"
#include "shapemap/io/log_selection.hpp"
#include "slam_method.hpp"

/// A method is given the odometry of estimated poses, or none.
namespace shapemap::baselines {

/// The uncertainty of motions for which no covariance is given.
struct MotionOptions {
  double unknown_sigma_m = 0.60;
  double unknown_sigma_rad = 20 * kDegree;
  double given_sigma_m = 0.05;
  double given_sigma_rad = 2 * kDegree;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"unknown-sigma-m", "deviation of a motion that nothing is known of [m]", 0.001, 10},
          self.unknown_sigma_m);
    visit(Field{"unknown-sigma-deg", "the same of the heading [deg]", 0.01, 180, kDegree}, self.unknown_sigma_rad);
    visit(Field{"given-sigma-m", "deviation of a motion that --poses gives [m]", 0.0001, 10}, self.given_sigma_m);
    visit(Field{"given-sigma-deg", "the same of the heading [deg]", 0.001, 180, kDegree}, self.given_sigma_rad);
  }
};

struct MotionSources {
  std::string poses_path;        ///< TUM lines; empty: none
  std::string covariances_path;  ///< motions with covariances; empty: none. Its motions count where there are no poses
};

/// Returns one motion for each scan that `selection` leaves of `log`. A scan without a pose counts as standing still,
/// and the motion to the next scan with a pose leads over it. Throws InputError, also for a line whose timestamp is not
/// that of a scan of the log, after those of the lines before it, and for one that might be of several.
std::vector<Motion> motions_for(const Log& log, const SelectionOptions& selection, const MotionSources& sources,
                                const MotionOptions& options);

/// Composes two motions, one after the other.
Motion compose(const Motion& first, const Motion& second);

}  // namespace shapemap::baselines
