// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>
#include <limits>
#include <vector>

#include "shapemap/matching/rotation_hypotheses.hpp"
#include "shapemap/matching/scan_matcher.hpp"
#include "support/views.hpp"

/// These tests fail for slow-downs by a multiple, on any machine: times are stated in those of a fixed piece of
/// arithmetic that is measured in turn with them, and the least of several counts.
namespace shapemap {
namespace {

#if defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
constexpr bool kIsMeasurable = true;
#else
constexpr bool kIsMeasurable = false;
#endif

constexpr int kRepetitions = 9;

/// Returns the processor time of this thread, which does not include other programs.
double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double seconds_of(const std::function<void()>& work) {
  const double start = cpu_seconds();
  work();
  return cpu_seconds() - start;
}

/// Computes angles, roots and votes all over a table, as the library does, but with none of its code.
double yardstick() {
  std::vector<float> table(6400, 0.0F);
  double x = 0.3;
  double y = 0.7;
  for (int i = 0; i < 20000; ++i) {
    const double angle = std::atan2(y, x);
    x = std::cos(angle + 1.0) + 0.01 * std::sqrt(1.0 + x * x);
    y = std::sin(angle * 1.7 + 0.1);
    table[static_cast<std::size_t>(3000.0 * (angle / kPi + 1.0))] += static_cast<float>(x);
  }
  return table[100] + x;
}

/// Returns the time of a piece of work, in yardsticks.
double length_of(const std::function<void()>& work) {
  double work_s = std::numeric_limits<double>::infinity();
  double yardstick_s = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kRepetitions; ++k) {
    double used = 0.0;  // keeps the compiler from leaving the work out
    yardstick_s = std::min(yardstick_s, seconds_of([&] { used = yardstick(); }));
    EXPECT_TRUE(std::isfinite(used));
    work_s = std::min(work_s, seconds_of(work));
  }
  return work_s / yardstick_s;
}

class Speed : public testing::Test {
 protected:
  void SetUp() override {
    if (!kIsMeasurable) GTEST_SKIP() << "built with sanitizers or without optimisation, which make no even slow-down";
  }

  const test::World world_ = test::cluttered_room(2);
  const ScanView reference_ = test::view_from(world_, {}, test::half_circle(), 1);
  const ScanView query_ = test::view_from(world_, {0.5, -0.3, 0.4}, test::half_circle(), 2);
};

// Each bound is two and a half times the measured time, which varies by 3 % from run to run. A change that is meant to
// do more work may raise its bound.

TEST_F(Speed, OfAView) {
  const Scan scan = test::scan_of(world_, {}, test::half_circle());
  EXPECT_LT(length_of([&] { test::view_of(scan); }), 1.25);
}

TEST_F(Speed, OfRotationHypotheses) {
  const auto hundred_times = [&] {
    for (int k = 0; k < 100; ++k) rotation_hypotheses(reference_.tangents, query_.tangents, 8);
  };
  EXPECT_LT(length_of(hundred_times), 1.25);
}

TEST_F(Speed, OfVotes) {
  const TranslationVoting voting(reference_, max_shift_m(reference_, query_, {}), {});
  const auto twenty_times = [&] {
    for (int k = 0; k < 20; ++k) voting.peaks(query_, 0.3 * k, 16);
  };
  EXPECT_LT(length_of(twenty_times), 1.1);
}

TEST_F(Speed, OfVisibility) {
  const auto hundred_times = [&] {
    for (int k = 0; k < 100; ++k) visibility(reference_, query_, {0.01 * k, -0.3, 0.4}, {});
  };
  EXPECT_LT(length_of(hundred_times), 3.9);
}

TEST_F(Speed, OfRefinement) {
  const auto ten_times = [&] {
    for (int k = 0; k < 10; ++k) refined_candidate(reference_, query_, {0.4 + 0.02 * k, -0.2, 0.35}, {});
  };
  EXPECT_LT(length_of(ten_times), 1.85);
}

TEST_F(Speed, OfAMatch) {
  EXPECT_LT(length_of([&] { match_scans(reference_, query_, {}); }), 9.7);
}

TEST_F(Speed, OfAMatchOfDifferentPlaces) {
  const ScanView elsewhere = test::view_from(test::strange_place(1), {});
  EXPECT_LT(length_of([&] { match_scans(reference_, elsewhere, {}); }), 24.7);
}

}  // namespace
}  // namespace shapemap
