// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <nlohmann/json.hpp>

#include "shapemap/io/pair_files.hpp"

namespace shapemap {
namespace {

using Json = nlohmann::ordered_json;

Json ranked_json(const RankedPose& ranked) {
  const Pose2& pose = ranked.ref_from_query;
  return {{"pose", {pose.x_m, pose.y_m, pose.theta_rad}},
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

Json ranked_json(const std::optional<RankedPose>& ranked) { return ranked ? ranked_json(*ranked) : Json(nullptr); }

Json covariance_json(const Eigen::Matrix3d& covariance) {
  if (!covariance.allFinite()) return nullptr;
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < 3; ++i) rows.push_back({covariance(i, 0), covariance(i, 1), covariance(i, 2)});
  return rows;
}

}  // namespace

std::string json_line(const AlignedPair& pair, bool with_seconds) {
  const Alignment& alignment = pair.alignment;
  Json all = {{"reference", pair.pair.reference},
              {"query", pair.pair.query},
              {"status", enum_name(alignment.status)},
              {"reason", alignment.reason},
              {"probability", alignment.probability},  // null when it is not a number
              {"covariance", covariance_json(alignment.covariance)}};
  if (with_seconds) all["seconds"] = pair.seconds;
  all["hypotheses"] = Json::array();
  for (const RankedPose& ranked : alignment.ranked) all["hypotheses"].push_back(ranked_json(ranked));
  if (pair.pair.given_ref_from_query) {
    all["given"] = ranked_json(pair.given);
    all["refined"] = ranked_json(pair.refined);
  }
  return all.dump() + "\n";
}

}  // namespace shapemap
