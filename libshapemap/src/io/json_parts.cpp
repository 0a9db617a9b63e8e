// SPDX-License-Identifier: GPL-3.0-or-later
#include "json_parts.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace shapemap {

Json number_json(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json pose_array(const Pose2& pose) {
  if (!std::isfinite(pose.x_m) || !std::isfinite(pose.y_m) || !std::isfinite(pose.theta_rad)) return nullptr;
  return Json::array({pose.x_m, pose.y_m, pose.theta_rad});
}

Json pose_arrays(const std::vector<Pose2>& poses) {
  Json list = Json::array();
  for (const Pose2& pose : poses) list.push_back(pose_array(pose));
  return list;
}

Json covariance_json(const Eigen::Matrix3d& covariance) {
  if (!covariance.allFinite()) return nullptr;
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < 3; ++i) rows.push_back({covariance(i, 0), covariance(i, 1), covariance(i, 2)});
  return rows;
}

Json ranked_json(const RankedPose& ranked) {
  return {{"pose", pose_array(ranked.ref_from_query)},
          {"score", ranked.score},
          {"agree", ranked.agree},
          {"cross_agree", ranked.cross_agree},
          {"crossed", ranked.crossed},
          {"hidden", ranked.hidden},
          {"unclear", ranked.unclear},
          {"outside", ranked.outside},
          {"rms_m", ranked.rms_m},
          {"partners", ranked.partners}};
}

double shown(double stored, double unit) {
  char text[32];
  std::snprintf(text, sizeof text, "%.14g", stored / unit);
  return std::strtod(text, nullptr);
}

}  // namespace shapemap
