// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/deskew/deskew.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "deskew/sweep_trial.hpp"
#include "shapemap/core/errors.hpp"
#include "shapemap/scan/beam_angles.hpp"
#include "shapemap/scan/joined_logs.hpp"
#include "shapemap/scan/plausibility.hpp"
#include "support/bent_sweeps.hpp"

namespace shapemap {
namespace {

using test::RollingLaser;
using testing::HasSubstr;

constexpr std::size_t kSweeps = 56;

struct Straightened {
  Log log;
  std::vector<SweepVerdict> verdicts;
  std::vector<std::string> warnings;
};

struct Listener : RunObserver {
  std::vector<std::string> warnings;
  bool stops = false;
  void on_warning(std::string_view message) override { warnings.emplace_back(message); }
  bool keep_going() override { return !stops; }
};

Straightened straightened_log(const Log& log, const DeskewOptions& options = {}, int threads = 1) {
  Listener listener;
  Straightened result;
  StraightenedLog straight = straightened(log, {}, options, 1, {threads, listener});
  result.log = std::move(straight.log);
  result.verdicts = std::move(straight.verdicts);
  result.warnings = listener.warnings;
  return result;
}

bool is_same(const Log& a, const Log& b) {
  return std::equal(a.scans.begin(), a.scans.end(), b.scans.begin(), b.scans.end(), [](const Scan& p, const Scan& q) {
    return p.sweeps[0].ranges_m == q.sweeps[0].ranges_m && p.sweeps[0].beam_angles_rad == q.sweeps[0].beam_angles_rad;
  });
}

RollingLaser noisy() {
  RollingLaser laser;
  laser.noise_m = 0.01;
  return laser;
}

TEST(Deskew, ASwingingLaserSeesStraightWallsAgain) {
  const test::World world = test::cluttered_room(5);
  RollingLaser laser = noisy();
  laser.num_beams = 240;
  for (const double yaw_rad : {15 * kDegree, 50 * kDegree}) {
    const Log bent = test::bent_log(world, test::swinging(yaw_rad, 0.2), kSweeps, laser);
    const double before_m = test::off_the_walls_m(bent, world);
    const Straightened result = straightened_log(bent);
    ASSERT_TRUE(result.verdicts[0].straightened);
    EXPECT_NEAR(result.verdicts[0].sweep_time_s, 0.1, 1e-9);
    EXPECT_THAT(result.verdicts[0].text, HasSubstr("sweeps of 0.1 s straightened"));
    EXPECT_EQ(result.verdicts[0].num_left, 0U);
    EXPECT_GT(before_m, 0.04);
    EXPECT_LT(test::off_the_walls_m(result.log, world), 0.018) << yaw_rad / kDegree;
  }
}

TEST(Deskew, WhatIsNotBentStaysBitForBit) {
  const test::World world = test::cluttered_room(5);
  RollingLaser at_once = noisy();
  at_once.sweep_share = 0.0;
  const Log log = test::bent_log(world, test::swinging(30 * kDegree, 0.2), kSweeps, at_once);
  const Straightened result = straightened_log(log);
  EXPECT_FALSE(result.verdicts[0].straightened);
  EXPECT_GT(result.verdicts[0].num_judged, 7U);
  EXPECT_TRUE(is_same(result.log, log));
  EXPECT_TRUE(result.verdicts[0].text.empty());
}

TEST(Deskew, ARobotThatStandsStaysBitForBit) {
  const test::World world = test::cluttered_room(5);
  const Log log = test::bent_log(world, test::swinging(0.0), 20);
  DeskewOptions on;
  on.mode = Deskew::kOn;
  EXPECT_TRUE(is_same(straightened_log(log, on).log, log));
  EXPECT_TRUE(is_same(straightened_log(log).log, log));
}

TEST(Deskew, AClockwiseLaserInAMirroredWorldIsTheMirrorImage) {
  test::World mirrored;
  const test::World world = test::cluttered_room(5);
  for (const test::Wall& wall : world) {
    mirrored.push_back({{wall.start_m.x(), -wall.start_m.y()}, {wall.end_m.x(), -wall.end_m.y()}});
  }
  RollingLaser laser;
  DeskewOptions on;
  on.mode = Deskew::kOn;
  const Log log = straightened_log(test::bent_log(world, test::swinging(30 * kDegree, 0.2), 12, laser), on).log;
  laser.clockwise = true;
  const Log other = straightened_log(test::bent_log(mirrored, test::swinging(-30 * kDegree, 0.2), 12, laser), on).log;
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    const Sweep& a = log.scans[i].sweeps[0];
    const Sweep& b = other.scans[i].sweeps[0];
    ASSERT_EQ(a.ranges_m.size(), b.ranges_m.size());
    for (std::size_t k = 0; k < a.ranges_m.size(); ++k) {
      EXPECT_NEAR(a.beam_angle_rad(k), -b.beam_angle_rad(k), 1e-3);
      EXPECT_NEAR(a.ranges_m[k], b.ranges_m[k], 3e-3);
    }
  }
}

TEST(Deskew, BeamsThatAreListedFromLastToFirstAreKnownByThat) {
  const test::World world = test::cluttered_room(5);
  Log log = test::bent_log(world, test::swinging(30 * kDegree, 0.2), kSweeps, noisy());
  for (Scan& scan : log.scans) {
    Sweep& sweep = scan.sweeps[0];
    std::reverse(sweep.ranges_m.begin(), sweep.ranges_m.end());
    sweep.first_angle_rad = sweep.beam_angle_rad(sweep.ranges_m.size() - 1);
    sweep.angle_step_rad = -sweep.angle_step_rad;
  }
  const Straightened result = straightened_log(log);
  EXPECT_NEAR(result.verdicts[0].sweep_time_s, -0.1, 1e-9);
  EXPECT_LT(test::off_the_walls_m(result.log, world), 0.018);
}

TEST(Deskew, TimesThatTheLogTellsAreUsed) {
  const test::World world = test::cluttered_room(5);
  RollingLaser laser = noisy();
  laser.sweep_share = 0.6;
  laser.view_rad = 240 * kDegree;
  Log log = test::bent_log(world, test::swinging(40 * kDegree, 0.2), kSweeps, laser);
  for (Scan& scan : log.scans) scan.sweeps[0].beam_time_step_s = laser.beam_step_s();
  const Straightened result = straightened_log(log);
  EXPECT_TRUE(result.verdicts[0].told);
  EXPECT_NEAR(result.verdicts[0].sweep_time_s, 0.06, 1e-3);
  EXPECT_LT(test::off_the_walls_m(result.log, world), 0.018);
}

TEST(Deskew, TimesThatCannotBeAreTold) {
  const test::World world = test::cluttered_room(5);
  for (const double lie_s : {1e-9, 1.0}) {
    Log log = test::bent_log(world, test::swinging(30 * kDegree, 0.2), kSweeps, noisy());
    for (Scan& scan : log.scans) scan.sweeps[0].beam_time_step_s = lie_s;
    const Straightened result = straightened_log(log);
    ASSERT_EQ(result.warnings.size(), 1U);
    EXPECT_THAT(result.warnings[0], HasSubstr("sweeps are 0.1 s apart"));
    EXPECT_FALSE(result.verdicts[0].told);
    EXPECT_NEAR(result.verdicts[0].sweep_time_s, 0.1, 1e-9);
  }
}

TEST(Deskew, TimesThatScansContradictAreTold) {
  const test::World world = test::cluttered_room(5);
  RollingLaser at_once = noisy();
  at_once.sweep_share = 0.0;
  Log log = test::bent_log(world, test::swinging(30 * kDegree, 0.2), kSweeps, at_once);
  for (Scan& scan : log.scans) scan.sweeps[0].beam_time_step_s = noisy().beam_step_s();
  const Straightened result = straightened_log(log);
  EXPECT_FALSE(result.verdicts[0].straightened);
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_THAT(result.warnings[0], HasSubstr("worse for it"));
}

TEST(Deskew, TimesThatTheLogTellsNeedNoProof) {
  const test::World world = test::cluttered_room(5);
  Log log = test::bent_log(world, test::swinging(30 * kDegree, 0.2), 12, noisy());
  for (Scan& scan : log.scans) scan.sweeps[0].beam_time_step_s = noisy().beam_step_s();
  EXPECT_TRUE(straightened_log(log).verdicts[0].straightened);
  for (Scan& scan : log.scans) scan.sweeps[0].beam_time_step_s = 0.0;
  EXPECT_FALSE(straightened_log(log).verdicts[0].straightened);
}

TEST(Deskew, ASweepTimeThatIsTypedIsTaken) {
  const test::World world = test::cluttered_room(5);
  const Log log = test::bent_log(world, test::swinging(30 * kDegree, 0.2), kSweeps, noisy());
  DeskewOptions options;
  options.sweep_time_s = 0.1;
  const Straightened result = straightened_log(log, options);
  EXPECT_EQ(result.verdicts[0].num_judged, 0U);
  EXPECT_LT(test::off_the_walls_m(result.log, world), 0.018);
  options.mode = Deskew::kOff;
  EXPECT_TRUE(is_same(straightened_log(log, options).log, log));
}

TEST(Deskew, StampsThatAreNoClockAreNotUsed) {
  const test::World world = test::cluttered_room(5);
  const Log log = test::bent_log(world, test::swinging(30 * kDegree, 0.2), 24, noisy());
  DeskewOptions on;
  on.mode = Deskew::kOn;
  for (const double step_s : {0.0, -0.1, 5.0, std::nan("")}) {
    Log other = log;
    for (std::size_t i = 0; i < log.scans.size(); ++i) {
      other.scans[i].timestamp_s = step_s * static_cast<double>(i);
    }
    const Straightened result = straightened_log(other, on);
    EXPECT_FALSE(result.verdicts[0].straightened) << step_s;
    EXPECT_TRUE(is_same(result.log, log));
  }
}

TEST(Deskew, AGapEndsAStretchAndFewSweepsTellNothing) {
  const test::World world = test::cluttered_room(5);
  Log log = test::bent_log(world, test::swinging(30 * kDegree, 0.2), 43, noisy());
  for (std::size_t i = 20; i < 23; ++i) log.scans[i].timestamp_s += 10.0;
  for (std::size_t i = 23; i < 43; ++i) log.scans[i].timestamp_s += 20.0;
  DeskewOptions options;
  options.sweep_time_s = 0.1;
  const Log straight = straightened_log(log, options).log;
  for (std::size_t i = 0; i < 43; ++i) {
    const bool is_straight = !straight.scans[i].sweeps[0].is_evenly_spaced();
    EXPECT_EQ(is_straight, i < 20 || i >= 23) << i;
  }
}

TEST(Deskew, EachOfSeveralLogsHasAVerdictOfItsOwn) {
  const test::World world = test::cluttered_room(5);
  RollingLaser at_once = noisy();
  at_once.sweep_share = 0.0;
  const Log bent = test::bent_log(world, test::swinging(30 * kDegree, 0.2), kSweeps, noisy());
  const Log straight = test::bent_log(world, test::swinging(30 * kDegree, 0.2), kSweeps, at_once);
  const Straightened result = straightened_log(joined_logs({straight, bent}));
  ASSERT_EQ(result.verdicts.size(), 2U);
  EXPECT_FALSE(result.verdicts[0].straightened);
  EXPECT_TRUE(result.verdicts[1].straightened);
}

TEST(Deskew, IsTheSameForAnyNumberOfThreads) {
  const test::World world = test::cluttered_room(5);
  const Log log = test::bent_log(world, test::swinging(30 * kDegree, 0.2), kSweeps, noisy());
  EXPECT_TRUE(is_same(straightened_log(log, {}, 1).log, straightened_log(log, {}, 3).log));
}

TEST(Deskew, EndsWhenAskedTo) {
  const Log log = test::bent_log(test::cluttered_room(5), test::swinging(30 * kDegree, 0.2), kSweeps, noisy());
  Listener listener;
  listener.stops = true;
  EXPECT_THROW(straightened(log, {}, {}, 1, {1, listener}), Interrupted);
}

TEST(Deskew, AnEmptyLogAndScansWithoutReturnsAreNoTrouble) {
  EXPECT_EQ(straightened_log({}).verdicts.size(), 1U);
  Log log = test::bent_log({}, test::swinging(30 * kDegree), 12);
  DeskewOptions on;
  on.mode = Deskew::kOn;
  EXPECT_TRUE(is_same(straightened_log(log, on).log, log));
  for (Scan& scan : log.scans) scan.sweeps.clear();
  EXPECT_EQ(straightened_log(log, on).log.scans.size(), 12U);
}

/// Any scans match if a motion against their beams bends each of them to a line.
TEST(Deskew, ScansOfPlacesFarApartAreNoSweeps) {
  const test::World world = test::cluttered_room(5);
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Log log;
  for (int i = 0; i < 80; ++i) {
    test::Scanner scanner;
    scanner.num_beams = 180;
    scanner.view_rad = kPi;
    log.scans.push_back(test::scan_of(world, {1.5 * unit(rng), 1.5 * unit(rng), 0.7 * i}, scanner, rng));
    log.scans.back().timestamp_s = 0.5 * i;
  }
  const Straightened result = straightened_log(log);
  EXPECT_FALSE(result.verdicts[0].straightened);
  EXPECT_TRUE(is_same(result.log, log));
}

TEST(Deskew, AThinnedRecordingIsJudgedByTheTurnsOfItsLaser) {
  const test::World world = test::cluttered_room(5);
  Log thinned = test::bent_log(world, test::swinging(20 * kDegree, 0.1), 4 * kSweeps, noisy());
  std::vector<Scan> kept;
  for (std::size_t i = 0; i < thinned.scans.size(); i += 2) kept.push_back(thinned.scans[i]);
  thinned.scans = kept;
  Listener listener;
  const auto [straight, verdicts] = straightened(thinned, {}, {}, 2, {1, listener});
  ASSERT_TRUE(verdicts[0].straightened);
  EXPECT_NEAR(verdicts[0].sweep_time_s, 0.1, 1e-9);
  EXPECT_LT(test::off_the_walls_m(straight, world), 0.5 * test::off_the_walls_m(thinned, world));
}

/// One time in another unit must cost neither memory nor the rest of the log.
TEST(Deskew, ABeamThatWasSentFarFromItsSweepEndsARun) {
  Log log = test::bent_log(test::cluttered_room(5), test::swinging(30 * kDegree, 0.2), kSweeps, noisy());
  for (Scan& scan : log.scans) scan.sweeps[0].beam_time_step_s = 0.1 / 120;
  log.scans[20].sweeps[0].start_s = 1e6;
  const Straightened result = straightened_log(log);
  EXPECT_TRUE(result.verdicts[0].straightened);
  EXPECT_GT(result.verdicts[0].num_sweeps, kSweeps / 2);
  EXPECT_EQ(result.log.scans[20].sweeps[0].ranges_m, log.scans[20].sweeps[0].ranges_m);
}

/// Several echoes of one beam have one angle before, and nearly the same angle after.
TEST(Deskew, EchoesOfOneBeamStayPlausible) {
  Log log = test::bent_log(test::cluttered_room(5), test::swinging(30 * kDegree, 0.2), 20, noisy());
  DeskewOptions on;
  on.mode = Deskew::kOn;
  for (Scan& scan : log.scans) {
    Sweep& sweep = scan.sweeps[0];
    Sweep echoes = sweep;
    echoes.ranges_m.clear();
    std::vector<double> angles_rad;
    for (std::size_t i = 0; i < sweep.ranges_m.size(); ++i) {
      for (const float farther_m : {0.0F, 0.4F}) {
        echoes.ranges_m.push_back(sweep.ranges_m[i] + farther_m);
        angles_rad.push_back(sweep.beam_angle_rad(i));
        echoes.beam_times_s.push_back(static_cast<float>(static_cast<double>(i) * 0.1 / 120));
      }
    }
    set_beam_angles(echoes, angles_rad);
    sweep = echoes;
  }
  const Straightened result = straightened_log(log, on);
  EXPECT_TRUE(result.verdicts[0].straightened);
  for (const Scan& scan : result.log.scans) EXPECT_EQ(implausibility(scan), "");
}

TEST(ChanceOfGains, IsThatOfTheTablesOfTheSignedRankTest) {
  EXPECT_EQ(chance_of_gains({}), 1.0);
  EXPECT_NEAR(chance_of_gains({1.0, 2.0, 3.0}), 1.0 / 8.0, 1e-12);
  EXPECT_NEAR(chance_of_gains({-1.0, 2.0, 3.0}), 2.0 / 8.0, 1e-12);
  EXPECT_NEAR(chance_of_gains({1.0, 2.0, -3.0}), 5.0 / 8.0, 1e-12);
  EXPECT_NEAR(chance_of_gains({0.0, 1.0, 1.0, -1.0}), 4.0 / 8.0, 1e-12);
  // For ten values, a sum of losses of at most 8 has the probability 0.0244.
  EXPECT_NEAR(chance_of_gains({1, 2, 3, 4, 5, 6, 7, -8, 9, 10}), 0.0244, 1e-4);
}

}  // namespace
}  // namespace shapemap
