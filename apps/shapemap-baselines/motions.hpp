// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "shapemap/core/options.hpp"
#include "shapemap/io/log_selection.hpp"
#include "slam_method.hpp"

/// The odometry that a method is given: none, or what estimated poses say.
namespace shapemap::baselines {

/// How far a pose may be from where its motion leads, where no covariance is given.
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

/// One motion for each position that `selection` leaves of `log`. A position without a pose counts as standing still,
/// and the motion to the next one with a pose leads over it. Throws InputError, also for a line whose timestamp is not
/// that of a position of the log, after those of the lines before it, and for one that might be of several.
std::vector<Motion> motions_for(const Log& log, const SelectionOptions& selection, const MotionSources& sources,
                                const MotionOptions& options);

/// Two motions one after the other.
Motion compose(const Motion& first, const Motion& second);

}  // namespace shapemap::baselines
