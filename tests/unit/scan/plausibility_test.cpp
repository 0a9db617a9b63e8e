// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/scan/plausibility.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "shapemap/core/errors.hpp"
#include "shapemap/core/observer.hpp"
#include "shapemap/mapper/map_log.hpp"
#include "shapemap/mapper/match_pairs.hpp"
#include "shapemap/scan/beam_angles.hpp"

namespace shapemap {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Sweep half_circle() {
  Sweep sweep;
  sweep.ranges_m.assign(181, 2.0F);
  sweep.first_angle_rad = -kPi / 2;
  sweep.angle_step_rad = kDegree;
  sweep.max_range_m = 81.83;
  return sweep;
}

TEST(Plausibility, SaysWhatIsFoundAndWhatWasExpected) {
  Sweep sweep = half_circle();
  EXPECT_THAT(implausibility(sweep), IsEmpty());
  sweep.angle_step_rad = 1e12;
  EXPECT_EQ(implausibility(sweep), "angle_step of 1e+12 rad, expected at most a full turn");
  sweep = half_circle();
  sweep.robot_from_sensor.x_m = -3e207;
  EXPECT_EQ(implausibility(sweep), "a mount's x of -3e+207 m, expected at most 100 m from the robot's origin");
}

TEST(Plausibility, EveryNumberOfASweepIsChecked) {
  const std::vector<double Sweep::*> numbers{&Sweep::first_angle_rad, &Sweep::angle_step_rad, &Sweep::min_range_m,
                                             &Sweep::max_range_m, &Sweep::nominal_heading_rad};
  const std::vector<double MountPose::*> of_mount{&MountPose::x_m,     &MountPose::y_m,       &MountPose::z_m,
                                                  &MountPose::yaw_rad, &MountPose::pitch_rad, &MountPose::roll_rad};
  for (const double wrong : {kNan, kInfinity, -kInfinity, 1e39, -1e39, 1e308}) {
    for (double Sweep::*number : numbers) {
      Sweep sweep = half_circle();
      sweep.*number = wrong;
      EXPECT_THAT(implausibility(sweep), HasSubstr("expected")) << wrong;
    }
    for (double MountPose::*number : of_mount) {
      Sweep sweep = half_circle();
      sweep.robot_from_sensor.*number = wrong;
      EXPECT_THAT(implausibility(sweep), AllOf(HasSubstr("mount"), HasSubstr("expected"))) << wrong;
    }
  }
}

TEST(Plausibility, WhatIsUnusualPasses) {
  Sweep sweep = half_circle();
  sweep.angle_step_rad = -2.0 * kPi / 180;  // clockwise, and all round
  sweep.first_angle_rad = 2.0 * kPi;
  sweep.robot_from_sensor = {-12.0, 3.0, 40.0, kPi, -0.1, -kPi};  // upside down on a crane
  sweep.nominal_heading_rad = 15 * 2.0 * kPi;
  sweep.max_range_m = std::numeric_limits<float>::max();
  sweep.min_range_m = -1.0;
  EXPECT_THAT(implausibility(sweep), IsEmpty());
  sweep.ranges_m.assign(1, 2.0F);  // one reading has no step
  sweep.angle_step_rad = 0.0;
  EXPECT_THAT(implausibility(sweep), IsEmpty());
  sweep.ranges_m.clear();
  EXPECT_THAT(implausibility(sweep), IsEmpty());
  EXPECT_THAT(implausible_time(1.7e18), IsEmpty());  // nanoseconds
  EXPECT_THAT(implausible_time(-5.0), IsEmpty());
  EXPECT_THAT(implausibility(Pose2{5e5, 5e6, 3.0}), IsEmpty());  // on the grid of a country
}

TEST(Plausibility, ASweepGoesRoundTwiceAtMostAndItsBeamsAreApart) {
  Sweep sweep = half_circle();
  sweep.angle_step_rad = 0.1;  // 180 beams make more than two turns
  EXPECT_THAT(implausibility(sweep), HasSubstr("18 rad, expected at most two full turns"));
  for (const double step_rad : {0.0, 1e-9, -1e-9, 1e-308}) {
    sweep.angle_step_rad = step_rad;
    EXPECT_THAT(implausibility(sweep), HasSubstr("for a scan of 181 beams")) << step_rad;
  }
  EXPECT_THAT(implausibility(half_circle(), 1'000'001), HasSubstr("1000001 beams"));
}

TEST(Plausibility, BeamsWithAnglesAndTimesOfTheirOwnAreCheckedOneByOne) {
  Sweep sweep;
  sweep.ranges_m.assign(3, 2.0F);
  set_beam_angles(sweep, {0.0, 0.1, 0.3});
  sweep.beam_times_s = {0.0F, 0.01F, 0.02F};
  sweep.intensities = {1.0F, 2.0F, 3.0F};
  EXPECT_THAT(implausibility(sweep), IsEmpty());
  Sweep wrong = sweep;
  wrong.beam_angles_rad[1] = kNan;
  EXPECT_THAT(implausibility(wrong), HasSubstr("a beam's angle of nan rad"));
  wrong = sweep;
  wrong.angle_step_rad = 1e-9;  // this step would make 300 million bearings of three beams
  EXPECT_THAT(implausibility(wrong), HasSubstr("at most a million steps"));
  wrong = sweep;
  wrong.beam_times_s[2] = std::numeric_limits<float>::infinity();
  EXPECT_THAT(implausibility(wrong), HasSubstr("a beam's time of inf s"));
  wrong = sweep;
  wrong.start_s = 1e9;
  EXPECT_THAT(implausibility(wrong), HasSubstr("the first beam's time of 1e+09 s"));
  wrong = sweep;
  wrong.beam_time_step_s = kNan;
  EXPECT_THAT(implausibility(wrong), HasSubstr("time_step of nan s"));
  wrong = sweep;
  wrong.intensities.pop_back();
  EXPECT_THAT(implausibility(wrong), HasSubstr("2 intensities, expected none or 3"));
  wrong = sweep;
  wrong.beam_angles_rad.push_back(0.4);
  EXPECT_THAT(implausibility(wrong), HasSubstr("4 beam angles, expected none or 3"));
}

TEST(Plausibility, OfAScanTheFirstFaultIsSaid) {
  Scan scan;
  scan.sweeps = {half_circle(), half_circle()};
  EXPECT_THAT(implausibility(scan), IsEmpty());
  scan.sweeps[1].angle_step_rad = kNan;
  EXPECT_THAT(implausibility(scan), HasSubstr("sub-scan 1: angle_step of nan rad"));
  scan.reference_pose = Pose2{kInfinity, 0.0, 0.0};
  EXPECT_THAT(implausibility(scan), HasSubstr("reference pose: x of inf m"));
  scan.timestamp_s = 1e300;
  EXPECT_THAT(implausibility(scan), HasSubstr("timestamp of 1e+300 s"));
}

/// Returns the message of the InputError that `work` throws.
template <class Work>
std::string refusal(const Work& work) {
  try {
    work();
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(Plausibility, MappingNamesTheScanOfALogThatWasMadeByHand) {
  Log log;
  log.scans.resize(5);
  for (Scan& scan : log.scans) scan.sweeps = {half_circle()};
  log.scans[3].sweeps[0].first_angle_rad = kNan;
  MappingEvents observer;
  EXPECT_THAT(refusal([&] { map_log(log, {}, observer); }), HasSubstr("position 3: first_angle of nan rad"));
  MappingOptions paper;
  paper.run.method = Method::kPaper;
  EXPECT_THAT(refusal([&] { map_log(log, paper, observer); }), HasSubstr("position 3: first_angle of nan rad"));
  EXPECT_THAT(refusal([&] { align_pairs(log, log, {{0, 1, {}}}, {}, observer); }), HasSubstr("position 3: "));
  log.scans.resize(3);
  EXPECT_THAT(refusal([&] {
                align_pairs(log, log, {{0, 1, Pose2{0.0, kNan, 0.0}}}, {}, observer);
              }),
              HasSubstr("the given pose of pair 0: y of nan m"));
}

TEST(Plausibility, ReadingsOfAnyKindAreNoFault) {
  Log log;
  log.scans.resize(2);
  for (Scan& scan : log.scans) scan.sweeps = {half_circle()};
  const std::vector<float> odd{std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),   -1.0F,
                               std::numeric_limits<float>::max(),       std::numeric_limits<float>::denorm_min(), 0.0F};
  for (std::size_t i = 0; i < 60; ++i) log.scans[0].sweeps[0].ranges_m[3 * i] = odd[i % odd.size()];
  log.scans[1].sweeps[0].ranges_m.assign(181, std::numeric_limits<float>::quiet_NaN());
  MappingEvents observer;
  const MapResult result = map_log(log, {}, observer);
  ASSERT_EQ(result.scans.size(), 2U);
  EXPECT_EQ(result.scans[1].component, -1);
}

}  // namespace
}  // namespace shapemap
