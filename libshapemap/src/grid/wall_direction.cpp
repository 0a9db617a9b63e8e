// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/grid/wall_direction.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "shapemap/grid/placed_rays.hpp"
#include "shapemap/grid/visits.hpp"

namespace shapemap {
namespace {

constexpr double kSideBySide = 6.0;          // beam spacings between neighbours on one surface that is seen at a slant
constexpr double kMostNoises = 4.0;          // points on a straight stretch are no farther off it than so many sigma
constexpr double kLeastTolerance_m = 1e-3;   // for ranges that are rounded to millimetres, or simulated without noise
constexpr std::size_t kLeastPoints = 6;      // of a straight stretch: two always lie on a line, three often nearly do
constexpr double kNear_rad = 5 * kDegree;    // walls of one direction, and errors of headings, differ by less
constexpr double kApart_rad = 10 * kDegree;  // walls that differ by less may have the same direction
constexpr int kBins = 360;                   // each is a quarter of a degree wide

struct Stretch {
  double angle_rad = 0.0;  ///< taken modulo 90 degrees
  double length_m = 0.0;
  double weight = 0.0;
};

double quarter_turn_wrapped(double angle_rad) { return std::remainder(angle_rad, kPi / 2); }

/// The returns of one sweep that lie side by side.
using Run = std::vector<Point2>;

std::vector<Run> runs_of(const Rays& rays) {
  std::vector<Run> runs;
  for (std::size_t i = 0; i < rays.hits_m.size(); ++i) {
    const double range_m = (rays.hits_m[i] - rays.from_m).norm();
    const bool goes_on =
        i > 0 && (rays.hits_m[i] - rays.hits_m[i - 1]).norm() <= kSideBySide * rays.beam_step_rad * range_m;
    if (!goes_on) runs.emplace_back();
    runs.back().push_back(rays.hits_m[i]);
  }
  return runs;
}

/// Adds the distances of points from the line between their neighbours. On straight walls, which most are, they spread
/// by noise alone.
void add_deviations(const Run& run, std::vector<double>& deviations_m) {
  for (std::size_t i = 1; i + 1 < run.size(); ++i) {
    const Point2 along = run[i + 1] - run[i - 1];
    const Point2 off = run[i] - run[i - 1];
    const double length_m = along.norm();
    if (length_m > 0.0) deviations_m.push_back(std::abs(along.x() * off.y() - along.y() * off.x()) / length_m);
  }
}

/// Returns the noise of single points from the median of the deviations, which have the noise of three points in them.
double noise_m(std::vector<double> deviations_m) {
  if (deviations_m.empty()) return 0.0;
  const auto middle = deviations_m.begin() + static_cast<std::ptrdiff_t>(deviations_m.size() / 2);
  std::nth_element(deviations_m.begin(), middle, deviations_m.end());
  return *middle / (0.6745 * std::sqrt(1.5));
}

/// The line through points [first, last) that has the least squared distances from them.
struct LineFit {
  Point2 middle_m{0.0, 0.0};
  Point2 direction{1.0, 0.0};

  LineFit(const Run& run, std::size_t first, std::size_t last) {
    const double count = static_cast<double>(last - first);
    for (std::size_t i = first; i < last; ++i) middle_m += run[i] / count;
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    for (std::size_t i = first; i < last; ++i) spread += (run[i] - middle_m) * (run[i] - middle_m).transpose();
    const double angle_rad = 0.5 * std::atan2(2.0 * spread(0, 1), spread(0, 0) - spread(1, 1));
    direction = {std::cos(angle_rad), std::sin(angle_rad)};
  }
  double distance_m(const Point2& p_m) const {
    const Point2 off = p_m - middle_m;
    return std::abs(direction.x() * off.y() - direction.y() * off.x());
  }
};

/// Splits a run where its points are farthest off their chord until all stretches are straight.
void add_stretches(const Run& run, double tolerance_m, std::vector<Stretch>& stretches) {
  std::vector<std::pair<std::size_t, std::size_t>> left_to_do{{0, run.size()}};
  while (!left_to_do.empty()) {
    const auto [first, last] = left_to_do.back();
    left_to_do.pop_back();
    if (last - first < kLeastPoints) continue;
    const Point2 chord = run[last - 1] - run[first];
    const double length_m = chord.norm();
    if (!(length_m > 2.0 * tolerance_m)) continue;
    std::size_t farthest = first;
    double most_m = 0.0;
    for (std::size_t i = first + 1; i + 1 < last; ++i) {
      const Point2 off = run[i] - run[first];
      const double off_m = std::abs(chord.x() * off.y() - chord.y() * off.x()) / length_m;
      if (off_m > most_m) {
        most_m = off_m;
        farthest = i;
      }
    }
    if (most_m > tolerance_m) {
      left_to_do.emplace_back(first, farthest + 1);
      left_to_do.emplace_back(farthest, last);
      continue;
    }
    const Point2 direction = LineFit(run, first, last).direction;
    stretches.push_back({quarter_turn_wrapped(std::atan2(direction.y(), direction.x())), length_m, 0.0});
  }
}

/// Returns the value such that half of the sum is in values that are not larger.
double middle_of_sum(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const double total = std::accumulate(values.begin(), values.end(), 0.0);
  double sum = 0.0;
  for (const double value : values) {
    sum += value;
    if (2.0 * sum >= total) return value;
  }
  return 0.0;
}

/// Weighs the stretches as wall_direction() describes; `visits` holds the stretches of each visit.
std::vector<Stretch> weighed(std::vector<std::vector<Stretch>> visits) {
  std::vector<double> lengths_m;
  for (const std::vector<Stretch>& visit : visits) {
    for (const Stretch& stretch : visit) lengths_m.push_back(stretch.length_m);
  }
  const double usual_m = middle_of_sum(std::move(lengths_m));
  std::vector<double> totals(visits.size(), 0.0);
  for (std::size_t i = 0; i < visits.size(); ++i) {
    for (Stretch& stretch : visits[i]) {
      stretch.weight = stretch.length_m * stretch.length_m / (stretch.length_m + usual_m);
      totals[i] += stretch.weight;
    }
  }
  const double usual_total = middle_of_sum(totals);
  std::vector<Stretch> all;
  for (std::size_t i = 0; i < visits.size(); ++i) {
    for (Stretch& stretch : visits[i]) {
      stretch.weight /= totals[i] + usual_total;
      all.push_back(stretch);
    }
  }
  return all;
}

/// Returns the weight within kNear_rad of an angle.
double weight_near(const std::vector<Stretch>& stretches, double angle_rad) {
  double weight = 0.0;
  for (const Stretch& stretch : stretches) {
    if (std::abs(quarter_turn_wrapped(stretch.angle_rad - angle_rad)) <= kNear_rad) weight += stretch.weight;
  }
  return weight;
}

/// Returns the mean direction within kNear_rad of an angle.
double mean_near(const std::vector<Stretch>& stretches, double angle_rad) {
  double sum = 0.0;
  double weight = 0.0;
  for (const Stretch& stretch : stretches) {
    const double off_rad = quarter_turn_wrapped(stretch.angle_rad - angle_rad);
    if (std::abs(off_rad) > kNear_rad) continue;
    sum += stretch.weight * off_rad;
    weight += stretch.weight;
  }
  return weight > 0.0 ? quarter_turn_wrapped(angle_rad + sum / weight) : angle_rad;
}

WallDirection direction_of(const std::vector<Stretch>& stretches) {
  WallDirection found;
  double total = 0.0;
  for (const Stretch& stretch : stretches) total += stretch.weight;
  if (!(total > 0.0)) return found;
  constexpr double bin_rad = kPi / 2 / kBins;
  std::array<double, kBins> near{};
  for (int i = 0; i < kBins; ++i) near[static_cast<std::size_t>(i)] = weight_near(stretches, i * bin_rad);
  const auto best = std::max_element(near.begin(), near.end());
  const double mode_rad = static_cast<double>(best - near.begin()) * bin_rad;
  for (int i = 0; i < kBins; ++i) {
    if (std::abs(quarter_turn_wrapped(i * bin_rad - mode_rad)) < kApart_rad) continue;
    found.second_share = std::max(found.second_share, near[static_cast<std::size_t>(i)] / total);
  }
  found.share = *best / total;
  found.angle_rad = quarter_turn_wrapped(mode_rad);
  for (int round = 0; round < 3; ++round) found.angle_rad = mean_near(stretches, found.angle_rad);
  return found;
}

}  // namespace

WallDirection wall_direction(const std::vector<Scan>& scans, const std::vector<PlacedScan>& placed,
                             const ReturnOptions& returns) {
  const std::vector<std::size_t> starts = starts_of_visits(placed);
  std::vector<std::vector<Run>> runs(starts.size() - 1);
  std::vector<double> deviations_m;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    for (const Rays& rays : rays_of(scans, placed[starts[i]], returns)) {
      for (Run& run : runs_of(rays)) {
        if (run.size() < kLeastPoints) continue;
        add_deviations(run, deviations_m);
        runs[i].push_back(std::move(run));
      }
    }
  }
  const double tolerance_m = std::max(kLeastTolerance_m, kMostNoises * noise_m(std::move(deviations_m)));
  std::vector<std::vector<Stretch>> visits(runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    for (const Run& run : runs[i]) add_stretches(run, tolerance_m, visits[i]);
  }
  return direction_of(weighed(std::move(visits)));
}

std::vector<WallDirection> align_walls(const std::vector<Scan>& scans, const ReturnOptions& returns,
                                       std::vector<Component>& components) {
  std::vector<WallDirection> directions;
  for (Component& component : components) {
    directions.push_back(wall_direction(scans, component.scans, returns));
    if (!directions.back().is_dominant()) continue;
    const Pose2 straight_from_map{0.0, 0.0, directions.back().turn_rad()};
    for (PlacedScan& place : component.scans) place.map_from_robot = straight_from_map * place.map_from_robot;
  }
  return directions;
}

}  // namespace shapemap
