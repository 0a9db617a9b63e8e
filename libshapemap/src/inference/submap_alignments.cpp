// SPDX-License-Identifier: GPL-3.0-or-later
#include "submap_alignments.hpp"
#include "inference_numbers.hpp"
#include "loops/loops_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace shapemap {
namespace {

std::size_t apart(std::size_t i, std::size_t j) { return i < j ? j - i : i - j; }

}  // namespace

SubmapAlignments::Seen SubmapAlignments::seen_from(std::size_t f, std::size_t joint) const {
  const EdgeCandidate& c = joints_[joint];
  const double worth = c.score;
  if (submap_of_node_[c.a] == f) {
    return {joint, c.a, c.b, submap_from_node_[c.a] * c.a_from_b, submap_from_node_[c.b], worth};
  }
  return {joint, c.b, c.a, submap_from_node_[c.b] * inverse(c.a_from_b), submap_from_node_[c.a], worth};
}

bool SubmapAlignments::agree(const Pose2& f_from_g, const Seen& one, const Seen& seed) {
  const Pose2 expected = f_from_g * one.g_from_b;
  const auto nodes = static_cast<double>(apart(one.a, seed.a) + apart(one.b, seed.b));
  const PoseTolerance& same = kLoops.clusters.same;
  const PoseTolerance& drift = kInference.agreement.drift_per_node;
  return agrees(expected, one.f_from_b, {same.m + drift.m * nodes, same.rad + drift.rad * nodes});
}

/// Returns the weighted mean of positions and directions (Umeyama 1991).
Pose2 SubmapAlignments::mean_of(const std::vector<Seen>& joints) {
  const MergingNumbers& numbers = kInference.merging;
  Point2 mean_f = Point2::Zero();
  Point2 mean_g = Point2::Zero();
  double sum = 0.0;
  for (const Seen& joint : joints) {
    const double weight = joint.worth + numbers.least_weight;
    mean_f += weight * joint.f_from_b.translation();
    mean_g += weight * joint.g_from_b.translation();
    sum += weight;
  }
  mean_f /= sum;
  mean_g /= sum;
  double sine = 0.0;
  double cosine = 0.0;
  for (const Seen& joint : joints) {
    const double weight = joint.worth + numbers.least_weight;
    const Point2 p = joint.f_from_b.translation() - mean_f;
    const Point2 q = joint.g_from_b.translation() - mean_g;
    const double turn_rad = joint.f_from_b.theta_rad - joint.g_from_b.theta_rad;
    sine += weight * (q.x() * p.y() - q.y() * p.x() + numbers.size_m2 * std::sin(turn_rad));
    cosine += weight * (q.dot(p) + numbers.size_m2 * std::cos(turn_rad));
  }
  const double theta_rad = std::atan2(sine, cosine);
  const Point2 shift = mean_f - rotate(mean_g, theta_rad);
  return {shift.x(), shift.y(), theta_rad};
}

/// Computes the strength as for a cluster of loops: the best candidate of each node, summed over the submap where the
/// sum is smaller. The sum is limited, because the scans see the same walls.
double SubmapAlignments::strength(const std::vector<Seen>& joints) const {
  std::map<std::size_t, double> by_f;
  std::map<std::size_t, double> by_g;
  for (const Seen& joint : joints) {
    double& of_a = by_f[joint.a];
    double& of_b = by_g[joint.b];
    of_a = std::max(of_a, joint.worth);
    of_b = std::max(of_b, joint.worth);
  }
  double of_f = 0.0;
  double of_g = 0.0;
  for (const auto& [unused, worth] : by_f) of_f += worth;
  for (const auto& [unused, worth] : by_g) of_g += worth;
  return std::min({of_f, of_g, trust_cap_});
}

std::vector<SubmapAlignment> SubmapAlignments::ways(std::size_t f, const std::vector<std::size_t>& between,
                                                    const std::vector<double>& noise) const {
  std::vector<Seen> seen;
  for (const std::size_t joint : between) seen.push_back(seen_from(f, joint));
  std::stable_sort(seen.begin(), seen.end(),
                   [](const Seen& one, const Seen& other) { return one.worth > other.worth; });
  std::vector<SubmapAlignment> found;
  std::set<std::size_t> used;
  for (const Seen& seed : seen) {
    if (found.size() == kInference.merging.most_ways) break;
    if (used.count(seed.joint) != 0) continue;
    SubmapAlignment way;
    std::vector<Seen> agreeing;
    const Pose2 f_from_g = seed.f_from_b * inverse(seed.g_from_b);
    for (const Seen& joint : seen) {
      if (joint.joint == seed.joint || agree(f_from_g, joint, seed)) agreeing.push_back(joint);
    }
    for (const Seen& joint : agreeing) way.joints.push_back(joint.joint);
    used.insert(way.joints.begin(), way.joints.end());
    way.f_from_g = mean_of(agreeing);
    way.gain = strength(agreeing) + (noise.empty() ? 0.0 : noise[seed.joint]);
    found.push_back(std::move(way));
  }
  return found;
}

bool SubmapAlignments::holds(const EdgeCandidate& c) const {
  return agrees(c.a_from_b, inverse(submap_from_node_[c.a]) * submap_from_node_[c.b], kLoops.clusters.same);
}

std::vector<Crossing> crossings(const std::vector<std::size_t>& of_f, const std::vector<std::size_t>& of_g) {
  std::vector<Crossing> found;
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < of_f.size() && j < of_g.size()) {
    const bool f_first = of_f[i] < of_g[j];
    const bool is_last =
        f_first ? i + 1 == of_f.size() || of_f[i + 1] > of_g[j] : j + 1 == of_g.size() || of_g[j + 1] > of_f[i];
    if (is_last) found.push_back({of_f[i], of_g[j], apart(of_f[i], of_g[j])});
    ++(f_first ? i : j);
  }
  return found;
}

}  // namespace shapemap
