// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "shapemap/paper/filters.hpp"

/// The filters against slow ones that are written from the paper's words, on random correspondences.
namespace shapemap {
namespace {

/// As in the paper: only the best main segment goes on.
Segments paper_segment_filter(const Segments& segments, FilterOptions options) {
  options.main_segments = 1;
  const std::vector<Segments> best = segment_filter(segments, options);
  return best.empty() ? Segments{} : best.front();
}

struct Case {
  Correspondences correspondences;
  FilterOptions options;
};

Case random_case(unsigned seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Case random;
  random.options = {10 * kDegree, 0.30, 1.0 + 2.0 * unit(rng), 0.4 * unit(rng)};
  const int count = static_cast<int>(60 * unit(rng));
  Point2 query_m(0.0, 0.0);
  Point2 target_m(1.0, 0.0);
  for (int i = 0; i < count; ++i) {
    const bool jumps = unit(rng) < 0.15;
    const double step_m = jumps ? 1.0 : 0.2;
    query_m += step_m * Point2(unit(rng), unit(rng));
    target_m += step_m * Point2(unit(rng), unit(rng));
    if (jumps) target_m = query_m + Point2(1.0 + unit(rng), 0.5 * unit(rng));
    Correspondence c;
    c.query_m = query_m;
    c.target_m = target_m;
    c.query_tangent_rad = 2 * kPi * unit(rng);
    c.target_tangent_rad = c.query_tangent_rad + 0.2 * unit(rng);
    c.indices = {static_cast<std::size_t>(i), static_cast<std::size_t>(2 * i)};
    c.target_scan = static_cast<std::size_t>(3 * i / std::max(count, 1));
    random.correspondences.push_back(c);
  }
  return random;
}

/// The query indices say which correspondences are left.
std::vector<std::size_t> names_of(const Correspondences& correspondences) {
  std::vector<std::size_t> names;
  for (const Correspondence& c : correspondences) names.push_back(c.indices.query);
  return names;
}

std::vector<std::vector<std::size_t>> names_of(const Segments& segments) {
  std::vector<std::vector<std::size_t>> names;
  for (const Correspondences& segment : segments) names.push_back(names_of(segment));
  return names;
}

Point2 slow_mean_m(const Correspondences& segment) {
  double x_m = 0.0;
  double y_m = 0.0;
  for (const Correspondence& c : segment) {
    x_m += c.target_m.x() - c.query_m.x();
    y_m += c.target_m.y() - c.query_m.y();
  }
  const auto n = static_cast<double>(segment.size());
  return {x_m / n, y_m / n};
}

double slow_distance_m(const Correspondence& c, const Point2& t) {
  return std::hypot(c.query_m.x() + t.x() - c.target_m.x(), c.query_m.y() + t.y() - c.target_m.y());
}

double slow_mean_distance_m(const Correspondences& segment, const Point2& t) {
  double sum_m = 0.0;
  for (const Correspondence& c : segment) sum_m += slow_distance_m(c, t);
  return sum_m / static_cast<double>(segment.size());
}

bool slides(const Correspondence& c, double tangent_rad, double limit_rad) {
  const Point2 t = c.target_m - c.query_m;
  const double cosine = std::abs(t.x() * std::cos(tangent_rad) + t.y() * std::sin(tangent_rad)) / t.norm();
  return cosine >= std::cos(limit_rad);
}

Segments slow_segment_filter(const Segments& segments, const FilterOptions& options) {
  Segments best;
  std::size_t best_count = 0;
  for (const Correspondences& main : segments) {
    const Point2 t = slow_mean_m(main);
    const double limit_m =
        slow_mean_distance_m(main, t) * options.segment_distance_factor + options.segment_distance_slack_m;
    Segments kept;
    std::size_t count = 0;
    for (const Correspondences& other : segments) {
      if (slow_mean_distance_m(other, t) > limit_m) continue;
      kept.push_back(other);
      count += other.size();
    }
    if (count > best_count) {
      best_count = count;
      best = kept;
    }
  }
  return best;
}

class FiltersAgainstOracle : public ::testing::TestWithParam<unsigned> {};

TEST_P(FiltersAgainstOracle, CollinearFilterDropsByTheCosineWithEitherTangent) {
  const Case random = random_case(GetParam());
  std::vector<std::size_t> expected;
  for (const Correspondence& c : random.correspondences) {
    const double limit_rad = random.options.collinear_angle_rad;
    if (slides(c, c.query_tangent_rad, limit_rad) || slides(c, c.target_tangent_rad, limit_rad)) continue;
    expected.push_back(c.indices.query);
  }
  EXPECT_EQ(names_of(collinear_filter(random.correspondences, random.options)), expected);
}

TEST_P(FiltersAgainstOracle, SegmentsAreTheRunsBetweenJumps) {
  const Case random = random_case(GetParam());
  std::vector<std::vector<std::size_t>> expected;
  for (std::size_t i = 0; i < random.correspondences.size(); ++i) {
    const Correspondence& c = random.correspondences[i];
    bool starts = i == 0;
    if (!starts) {
      const Correspondence& before = random.correspondences[i - 1];
      starts = before.target_scan != c.target_scan || (before.query_m - c.query_m).norm() >= 0.30 ||
               (before.target_m - c.target_m).norm() >= 0.30;
    }
    if (starts) expected.emplace_back();
    expected.back().push_back(i);
  }
  EXPECT_EQ(names_of(cut_into_segments(random.correspondences, random.options)), expected);
}

TEST_P(FiltersAgainstOracle, SegmentFilterKeepsWhatTheBestMainSegmentLeaves) {
  const Case random = random_case(GetParam());
  const Segments segments = cut_into_segments(random.correspondences, random.options);
  EXPECT_EQ(names_of(paper_segment_filter(segments, random.options)),
            names_of(slow_segment_filter(segments, random.options)));
}

TEST_P(FiltersAgainstOracle, SegmentTranslationKeepsMostPairs) {
  const Case random = random_case(GetParam());
  const Segments segments = cut_into_segments(random.correspondences, random.options);
  std::vector<std::size_t> expected;
  for (const Correspondences& main : segments) {
    const Point2 t = slow_mean_m(main);
    const double limit_m = slow_mean_distance_m(main, t) + 1e-9;
    std::vector<std::size_t> kept;
    for (const Correspondences& other : segments) {
      for (const Correspondence& c : other) {
        if (slow_distance_m(c, t) <= limit_m) kept.push_back(c.indices.query);
      }
    }
    if (kept.size() > expected.size()) expected = kept;
  }
  const SegmentTranslation best = segment_wise_translation(segments);
  EXPECT_EQ(names_of(best.kept), expected);
  EXPECT_EQ(best.num_correspondences, static_cast<int>(expected.size()));
  EXPECT_EQ(best.num_correspondences == 0, segments.empty());
}

INSTANTIATE_TEST_SUITE_P(Seeds, FiltersAgainstOracle, ::testing::Range(0U, 60U));

}  // namespace
}  // namespace shapemap
