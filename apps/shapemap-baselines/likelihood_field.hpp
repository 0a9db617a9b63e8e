// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "shapemap/core/pose2.hpp"

namespace shapemap::baselines {

/// A spot is a place where beams ended, with the share of the beams reaching it that did.
struct OccupiedSpot {
  Point2 p_m;
  double occupancy = 0.0;
};

/// The likelihood of a beam to end at a place, smoothed by a Gaussian: 1 on a certain wall, 0 far from all.
class LikelihoodField {
 public:
  LikelihoodField(const std::vector<OccupiedSpot>& spots, double sigma_m);

  double sigma_m() const { return sigma_m_; }
  /// Interpolates between the centres of the cells; the field is 0 outside.
  double at(const Point2& p_m) const;

 private:
  void stamp(const OccupiedSpot& spot);
  const float* row(int y) const {
    return cells_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
  }

  double sigma_m_;
  double cell_m_;
  Point2 origin_m_{0.0, 0.0};  ///< centre of the first cell
  int width_ = 0;
  int height_ = 0;
  std::vector<float> cells_;
};

}  // namespace shapemap::baselines
