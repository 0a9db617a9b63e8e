// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/matching/translation_voting.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "support/matchers.hpp"
#include "support/views.hpp"

namespace shapemap {
namespace {

using test::IsNearPoint;

/// Returns a view that has only what voting uses.
ScanView random_view(unsigned seed, std::size_t num_points, double half_size_m = 4.0) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  ScanView view;
  for (std::size_t i = 0; i < num_points; ++i) {
    const Point2 p_m(half_size_m * (2.0 * unit(rng) - 1.0), half_size_m * (2.0 * unit(rng) - 1.0));
    view.points.push_back({p_m, 2 * kPi * unit(rng), 0});
    view.weights.push_back(0.1 + unit(rng));
  }
  return view;
}

/// Returns the same points in another frame.
ScanView moved_view(const ScanView& view, const Pose2& b_from_a) {
  ScanView result;
  result.weights = view.weights;
  for (const ShapePoint& point : view.points) {
    result.points.push_back({b_from_a * point.p_m, point.tangent_rad + b_from_a.theta_rad, 0});
  }
  return result;
}

/// Counts the votes of all pairs by their definition: a vote goes to its cell, and with a half and a quarter of its
/// weight to the cells beside it.
class SlowVoting {
 public:
  SlowVoting(const ScanView& reference, const ScanView& query, double rotation_rad, double max_shift_m,
             const VotingOptions& options)
      : cell_m_(options.cell_m), side_(static_cast<int>(std::ceil(max_shift_m / options.cell_m))) {
    for (std::size_t q = 0; q < query.size(); ++q) {
      for (std::size_t r = 0; r < reference.size(); ++r) {
        const double off_rad =
            angle_between(query.points[q].tangent_rad + rotation_rad, reference.points[r].tangent_rad);
        const Point2 shift_m = reference.points[r].p_m - rotate(query.points[q].p_m, rotation_rad);
        if (off_rad > options.tangent_tolerance_rad || shift_m.cwiseAbs().maxCoeff() > max_shift_m) continue;
        cast(cell(shift_m.x()), cell(shift_m.y()), query.weights[q] * reference.weights[r]);
      }
    }
  }

  int cell(double shift_m) const { return static_cast<int>(std::floor(shift_m / cell_m_ + 0.5)); }
  double at(const Point2& shift_m) const { return at(cell(shift_m.x()), cell(shift_m.y())); }
  double at(int column, int row) const {
    const auto found = votes_.find({column, row});
    return found == votes_.end() ? 0.0 : found->second;
  }
  double most() const {
    double most = 0.0;
    for (const auto& [place, votes] : votes_) {
      if (std::abs(place.first) <= side_ && std::abs(place.second) <= side_) most = std::max(most, votes);
    }
    return most;
  }

 private:
  void cast(int column, int row, double weight) {
    for (int c = -1; c <= 1; ++c) {
      for (int r = -1; r <= 1; ++r) votes_[{column + c, row + r}] += weight * (2 - std::abs(c)) * (2 - std::abs(r));
    }
  }

  double cell_m_;
  int side_;
  std::map<std::pair<int, int>, double> votes_;
};

TEST(TranslationVoting, ReturnsTheCellsWithMostVotesOfAllPairs) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const ScanView reference = random_view(seed, 60);
    const ScanView query = random_view(100 + seed, 50);
    VotingOptions options;
    options.cell_m = 0.1 + 0.05 * (seed % 5);
    options.tangent_tolerance_rad = (5.0 + 20.0 * (seed % 4)) * kDegree;
    const double max_shift_m = 1.0 + 0.7 * (seed % 6);
    const double rotation_rad = 0.5 * seed - 5.0;
    const SlowVoting slow(reference, query, rotation_rad, max_shift_m, options);
    const std::vector<Point2> peaks = TranslationVoting(reference, max_shift_m, options).peaks(query, rotation_rad, 12);
    ASSERT_FALSE(peaks.empty());
    EXPECT_NEAR(slow.at(peaks[0]), slow.most(), 1e-3) << seed;
    for (std::size_t i = 0; i < peaks.size(); ++i) {
      EXPECT_GT(slow.at(peaks[i]), 0.0);
      if (i > 0) {
        EXPECT_LE(slow.at(peaks[i]), slow.at(peaks[i - 1]) + 1e-3);
      }
      EXPECT_LE(peaks[i].cwiseAbs().maxCoeff(), max_shift_m + options.cell_m);
      for (std::size_t k = 0; k < i; ++k) {
        EXPECT_GT((peaks[i] - peaks[k]).cwiseAbs().maxCoeff(), 1.5 * options.cell_m) << "two cells or more apart";
      }
    }
  }
}

TEST(TranslationVoting, LeavesNoCellOutThatHasMoreVotes) {
  const ScanView reference = random_view(1, 60);
  const ScanView query = random_view(2, 60);
  const VotingOptions options;
  const SlowVoting slow(reference, query, 0.3, 2.0, options);
  const std::vector<Point2> peaks = TranslationVoting(reference, 2.0, options).peaks(query, 0.3, 8);
  ASSERT_EQ(peaks.size(), 8U);
  for (int column = -10; column <= 10; ++column) {
    for (int row = -10; row <= 10; ++row) {
      const Point2 place_m(column * options.cell_m, row * options.cell_m);
      const bool beside_one = std::any_of(peaks.begin(), peaks.end(), [&](const Point2& peak) {
        return (peak - place_m).cwiseAbs().maxCoeff() < 1.5 * options.cell_m;
      });
      if (!beside_one) {
        EXPECT_LE(slow.at(column, row), slow.at(peaks.back()) + 1e-3);
      }
    }
  }
}

TEST(TranslationVoting, FindsTheShiftOfAMovedCopy) {
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> shift(-2.5, 2.5);
  for (unsigned seed = 0; seed < 30; ++seed) {
    const ScanView reference = random_view(seed, 80);
    const Pose2 ref_from_query{shift(rng), shift(rng), 2.0 * shift(rng)};
    const ScanView query = moved_view(reference, inverse(ref_from_query));
    const std::vector<Point2> peaks = TranslationVoting(reference, 3.0, {}).peaks(query, ref_from_query.theta_rad, 3);
    ASSERT_FALSE(peaks.empty());
    EXPECT_THAT(peaks[0], IsNearPoint(ref_from_query.translation(), 0.15)) << seed;  // half a diagonal of a cell
  }
}

TEST(TranslationVoting, PairsTangentsAcrossTheFullTurn) {
  for (const double tangent_rad : {0.0, -1e-18, 1e-9, -1e-9, 2 * kPi, kPi}) {
    ScanView reference;
    reference.points = {{{1.0, 0.0}, tangent_rad, 0}};
    reference.weights = {1.0};
    for (const double query_rad : {tangent_rad, tangent_rad + 9 * kDegree, tangent_rad - 9 * kDegree}) {
      ScanView query;
      query.points = {{{0.0, 0.0}, query_rad, 0}};
      query.weights = {1.0};
      EXPECT_EQ(TranslationVoting(reference, 2.0, {}).peaks(query, 0.0, 5).size(), 1U) << tangent_rad;
      query.points[0].tangent_rad += 40 * kDegree;
      EXPECT_TRUE(TranslationVoting(reference, 2.0, {}).peaks(query, 0.0, 5).empty());
    }
  }
}

TEST(TranslationVoting, HasNoVotesForFartherMotions) {
  ScanView reference;
  reference.points = {{{1.0, -1.0}, 0.0, 0}};
  reference.weights = {1.0};
  ScanView query;
  query.points = {{{0.0, 0.0}, 0.0, 0}};
  query.weights = {1.0};
  for (const double max_shift_m : {0.01, 0.5, 0.99}) {
    EXPECT_TRUE(TranslationVoting(reference, max_shift_m, {}).peaks(query, 0.0, 5).empty());
  }
  for (const double max_shift_m : {1.0, 1.05, 1.2, 50.0}) {
    const std::vector<Point2> peaks = TranslationVoting(reference, max_shift_m, {}).peaks(query, 0.0, 5);
    ASSERT_EQ(peaks.size(), 1U);
    EXPECT_THAT(peaks[0], IsNearPoint(Point2(1.0, -1.0), 0.15));
  }
}

/// An index would go wrong first at the borders of the grid, which sanitizers report.
TEST(TranslationVoting, StaysInsideItsGridForAllOptions) {
  const ScanView reference = random_view(7, 200, 8.0);
  const ScanView query = random_view(8, 200, 8.0);
  for (const double cell_m : {0.02, 0.3, 2.0}) {
    for (const double max_shift_m : {0.001, 0.1, 0.2, 0.6, 2.0, 8.0}) {
      for (const double tolerance_rad : {1 * kDegree, 90 * kDegree}) {
        VotingOptions options;
        options.cell_m = cell_m;
        options.tangent_tolerance_rad = tolerance_rad;
        const TranslationVoting voting(reference, max_shift_m, options);
        for (const Point2& peak : voting.peaks(query, 1.0, 1000)) {
          EXPECT_LE(peak.cwiseAbs().maxCoeff(), max_shift_m + cell_m);
        }
      }
    }
  }
}

TEST(TranslationVoting, OfNothingReturnsNothing) {
  const ScanView nothing;
  const ScanView something = random_view(1, 20);
  EXPECT_TRUE(TranslationVoting(nothing, 2.0, {}).peaks(something, 0.0, 5).empty());
  EXPECT_TRUE(TranslationVoting(something, 2.0, {}).peaks(nothing, 0.0, 5).empty());
  EXPECT_GT(max_shift_m(nothing, nothing, {}), 0.0);
}

TEST(MaxShift, GrowsWithTheReachUnlessItIsGiven) {
  ScanView near_sighted;
  near_sighted.reach_m = 4.0;
  ScanView far_sighted;
  far_sighted.reach_m = 8.0;
  VotingOptions options;
  EXPECT_LT(max_shift_m(near_sighted, near_sighted, options), max_shift_m(near_sighted, far_sighted, options));
  EXPECT_EQ(max_shift_m(near_sighted, far_sighted, options), max_shift_m(far_sighted, near_sighted, options));
  options.max_shift_m = 1.5;
  EXPECT_EQ(max_shift_m(near_sighted, far_sighted, options), 1.5);
}

}  // namespace
}  // namespace shapemap
