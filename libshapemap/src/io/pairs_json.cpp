// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/io/pair_files.hpp"

#include "json_parts.hpp"

namespace shapemap {
namespace {

Json ranked_json(const std::optional<RankedPose>& ranked) { return ranked ? ranked_json(*ranked) : Json(nullptr); }

}  // namespace

std::string json_line(const AlignedPair& pair, bool with_seconds) {
  const ScanMatch& match = pair.match;
  Json all = {{"reference", pair.pair.reference},
              {"query", pair.pair.query},
              {"status", enum_name(match.status)},
              {"reason", match.reason},
              {"probability", match.probability},  // null when it is not a number
              {"covariance", covariance_json(match.covariance)}};
  if (with_seconds) all["seconds"] = pair.seconds;
  all["hypotheses"] = Json::array();
  for (const RankedPose& ranked : match.ranked) all["hypotheses"].push_back(ranked_json(ranked));
  if (pair.pair.given_ref_from_query) {
    all["given"] = ranked_json(pair.given);
    all["refined"] = ranked_json(pair.refined);
  }
  return all.dump() + "\n";
}

}  // namespace shapemap
