// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/inference/map_score.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "inference_numbers.hpp"
#include "loops/loops_numbers.hpp"
#include "shapemap/core/parallel_for.hpp"

namespace shapemap {
namespace {

/// Says whether a pair must be compared anew. It tests each axis by itself, so that a known value holds for one small
/// square.
bool moved(const Pose2& a, const Pose2& b) {
  const PoseTolerance& known = kInference.agreement.known;
  return (a.translation() - b.translation()).lpNorm<Eigen::Infinity>() > known.m ||
         angle_between(a.theta_rad, b.theta_rad) > known.rad;
}

/// Says whether a pair is rated. Successive keyframes tell nothing new, and of the others there are more than enough.
bool is_asked(std::size_t a, std::size_t b) {
  const MapScoreNumbers& numbers = kInference.map_score;
  return b - a >= numbers.least_apart && (b - a < numbers.same_stretch || (a % 2 == 0 && b % 2 == 0));
}

}  // namespace

double MapScore::of_pair(const Visibility& v) {
  const double total = std::max(v.total(), 1e-9);
  const MapScoreWeights& weights = kInference.map_score_weights;
  return weights.agree * std::log((weights.agree_offset + v.agree / total) / weights.agree_offset) +
         weights.crossed * std::log((weights.crossed_offset + v.crossed / total) / weights.crossed_offset);
}

double MapScore::of(const std::vector<Pose2>& map_from_node, const std::vector<std::size_t>& ring_of_node) {
  std::vector<RelativePose> pairs;
  for (const auto& [a, b] : near_pairs(map_from_node, kInference.map_score.within_m)) {
    if (!is_asked(a, b)) continue;
    const bool is_held =
        ring_of_node.empty() || b - a < kLoops.aliasing.long_chain || ring_of_node[a] == ring_of_node[b];
    pairs.push_back(
        {a, b, inverse(map_from_node[a]) * map_from_node[b], is_held ? 1.0 : kInference.map_score_weights.unheld});
  }
  return of_pairs(pairs);
}

double MapScore::between(const std::vector<Pose2>& pose_in_submap, const std::vector<std::size_t>& f,
                         const std::vector<std::size_t>& g, const Pose2& f_from_g) {
  const double within_m = kInference.map_score.within_m;
  std::vector<RelativePose> pairs;
  for (const std::size_t j : g) {
    const Pose2 there = f_from_g * pose_in_submap[j];
    for (const std::size_t i : f) {
      if ((pose_in_submap[i].translation() - there.translation()).squaredNorm() >= within_m * within_m) continue;
      const Pose2 f_from_j = inverse(pose_in_submap[i]) * there;
      if (is_asked(std::min(i, j), std::max(i, j))) {
        pairs.push_back(i < j ? RelativePose{i, j, f_from_j, 1.0} : RelativePose{j, i, inverse(f_from_j), 1.0});
      }
    }
  }
  const std::size_t stride = pairs.size() / kInference.map_score.pairs_between + 1;
  std::vector<RelativePose> some;
  for (std::size_t i = 0; i < pairs.size(); i += stride) some.push_back(pairs[i]);
  if (some.empty()) return 0.0;
  return of_pairs(some, static_cast<double>(pairs.size()) / static_cast<double>(some.size()));
}

double MapScore::of_pairs(const std::vector<RelativePose>& pairs, double each_stands_for) {
  std::vector<Known*> known;
  known.reserve(pairs.size());
  std::vector<std::size_t> stale;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto [found, is_new] = known_.try_emplace(pairs[i].a * views_.size() + pairs[i].b);
    known.push_back(&found->second);
    if (is_new || moved(found->second.a_from_b, pairs[i].a_from_b)) stale.push_back(i);
  }
  parallel_for(stale.size(), threads_, [&](std::size_t k) {
    const RelativePose& pair = pairs[stale[k]];
    const Visibility seen = visibility(*views_[pair.a], *views_[pair.b], pair.a_from_b, options_,
                                       {kInference.map_score.slack, kInference.map_score.stride});
    *known[stale[k]] = {pair.a_from_b, of_pair(seen)};
  });
  double sum = 0.0;
  std::map<std::size_t, double> by_others;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const double value = known[i]->value * each_stands_for * pairs[i].counts;
    if (value < 0.0 || pairs[i].b - pairs[i].a < kInference.map_score.same_stretch) {
      sum += value;
    } else {
      by_others[pairs[i].a] += 0.5 * value;
      by_others[pairs[i].b] += 0.5 * value;
    }
  }
  const double most = kInference.map_score_weights.most_by_others;
  for (const auto& [unused, gain] : by_others) sum += most * (1.0 - std::exp(-gain / most));
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
