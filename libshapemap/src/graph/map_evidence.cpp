// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/graph/map_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "shapemap/core/parallel_for.hpp"

namespace shapemap {
namespace {

constexpr double kWithin_m = 6.0;
constexpr std::size_t kLeastApart = 2;   // along the chain
constexpr std::size_t kSameStretch = 8;  // all pairs of nodes this near along the chain are asked, else one in four
constexpr std::size_t kStride = 3;
constexpr double kSlack = 2.0;

/// Less changes nothing that matters.
bool moved(const Pose2& a, const Pose2& b) {
  return (a.translation() - b.translation()).lpNorm<Eigen::Infinity>() > 0.03 ||
         angle_between(a.theta_rad, b.theta_rad) > 0.4 * kDegree;
}

}  // namespace

double MapEvidence::of_pair(const Visibility& v) {
  const double total = std::max(v.total(), 1e-9);
  return 2.0 * std::log((0.2 + v.agree / total) / 0.2) - 2.0 * std::log((0.05 + v.crossed / total) / 0.05);
}

double MapEvidence::of(const std::vector<Pose2>& map_from_node) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const auto& pair : near_pairs(map_from_node, kWithin_m)) {
    const std::size_t apart = pair.second - pair.first;
    const bool asked = apart < kSameStretch || (pair.first % 2 == 0 && pair.second % 2 == 0);
    if (apart >= kLeastApart && asked) pairs.push_back(pair);
  }
  std::vector<Known*> known;
  std::vector<std::size_t> stale;
  std::vector<Pose2> poses;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto [found, is_new] = known_.try_emplace(pairs[i]);
    known.push_back(&found->second);
    poses.push_back(inverse(map_from_node[pairs[i].first]) * map_from_node[pairs[i].second]);
    if (is_new || moved(found->second.a_from_b, poses.back())) stale.push_back(i);
  }
  parallel_for(stale.size(), threads_, [&](std::size_t k) {
    const std::size_t i = stale[k];
    const Visibility seen =
        visibility(*views_[pairs[i].first], *views_[pairs[i].second], poses[i], options_, kSlack, kStride);
    *known[i] = {poses[i], of_pair(seen)};
  });
  double sum = 0.0;
  for (const Known* pair : known) sum += pair->value;
  return sum;
}

std::vector<std::pair<std::size_t, std::size_t>> near_pairs(const std::vector<Pose2>& map_from_node, double within_m) {
  using Cell = std::pair<long, long>;
  const auto cell_of = [&](const Pose2& pose) {
    return Cell{std::lround(std::floor(pose.x_m / within_m)), std::lround(std::floor(pose.y_m / within_m))};
  };
  std::map<Cell, std::vector<std::size_t>> cells;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t b = 0; b < map_from_node.size(); ++b) {
    const Cell cell = cell_of(map_from_node[b]);
    const std::size_t first = pairs.size();
    for (long dx = -1; dx <= 1; ++dx) {
      for (long dy = -1; dy <= 1; ++dy) {
        const auto found = cells.find({cell.first + dx, cell.second + dy});
        if (found == cells.end()) continue;
        for (const std::size_t a : found->second) {
          if ((map_from_node[a].translation() - map_from_node[b].translation()).norm() < within_m) {
            pairs.emplace_back(a, b);
          }
        }
      }
    }
    std::sort(pairs.begin() + static_cast<std::ptrdiff_t>(first), pairs.end());
    cells[cell].push_back(b);
  }
  return pairs;
}

}  // namespace shapemap
