// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/logs.hpp"
#include "support/temp_folder.hpp"

namespace shapemap {
namespace {

using test::expect_same_points;
using test::make_sweep;
using test::TempFolder;
using testing::HasSubstr;

constexpr double kTolerance_m = 1e-5;  // MRPT stores the field of view as a float
constexpr LogFormat kFormats[] = {LogFormat::kRawlog, LogFormat::kCarmen, LogFormat::kNist};

/// The log has all that is hard to keep: turns, offsets, clockwise, upside-down and tilted lasers, angles off the
/// middle.
Log awkward_log() {
  Log log;
  log.format = "nist";
  for (int i = 0; i < 3; ++i) {
    Scan scan;
    scan.timestamp_s = 1137834225.7133856 + 0.125 * i;
    for (int turn = 0; turn < 4; ++turn) {
      Sweep sweep = make_sweep(101, -50 * kDegree, kDegree);
      sweep.nominal_heading_rad = wrap_angle(turn * 90 * kDegree);
      sweep.robot_from_sensor = {0.1, -0.05, 0.3, 0.2, 0.0, 0.0};
      scan.sweeps.push_back(sweep);
    }
    scan.sweeps[1].sensor_label = "second laser #2";
    scan.sweeps[1].first_angle_rad = -10 * kDegree;
    scan.sweeps[1].min_range_m = 1.105;
    scan.sweeps[2].angle_step_rad = -0.7 * kDegree;
    scan.sweeps[2].first_angle_rad = 80 * kDegree;
    scan.sweeps[2].robot_from_sensor.roll_rad = kPi;
    scan.sweeps[3].robot_from_sensor.pitch_rad = 10 * kDegree;
    scan.sweeps[3].robot_from_sensor.roll_rad = -5 * kDegree;
    scan.sweeps[3].max_range_m = 0.0;
    log.scans.push_back(scan);
  }
  return log;
}

Log flaser_log() {
  Log log;
  Scan scan;
  scan.timestamp_s = 12.5;
  scan.sweeps.push_back(make_sweep(181, -90 * kDegree, kDegree));
  log.scans.push_back(scan);
  return log;
}

TEST(Convert, AnyFormatToAnyOtherKeepsThePoints) {
  const TempFolder folder;
  const Log log = awkward_log();
  for (const LogFormat first : kFormats) {
    const std::string first_path = folder.path("first." + enum_name(first));
    write_log(log, first_path, first);
    EXPECT_EQ(recognise_log_format(first_path), first);
    const Log once = read_log(first_path);
    EXPECT_TRUE(once.warnings.empty());
    SCOPED_TRACE(enum_name(first));
    expect_same_points(log, once, kTolerance_m);
    for (const LogFormat second : kFormats) {
      SCOPED_TRACE(enum_name(second));
      const std::string second_path = folder.path("second." + enum_name(second) + ".gz");
      write_log(once, second_path, second);
      expect_same_points(log, read_log(second_path), 2 * kTolerance_m);
    }
  }
}

TEST(Convert, ATimeThatARawlogCannotHoldIsRefused) {
  const TempFolder folder;
  for (const double timestamp_s : {1e300, -1e300, 1e12, -2e10, std::nan("")}) {
    Log log = flaser_log();
    log.scans.push_back(log.scans.front());
    log.scans.back().timestamp_s = timestamp_s;
    try {
      write_log(log, folder.path("a.rawlog"), LogFormat::kRawlog);
      ADD_FAILURE() << timestamp_s;
    } catch (const OutputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("position 1 has the timestamp"));
    }
    EXPECT_TRUE(folder.names().empty());
  }
}

TEST(Convert, WhatIsNotKeptIsSaid) {
  Log log = awkward_log();
  EXPECT_EQ(what_is_lost(log, LogFormat::kNist), "");
  EXPECT_THAT(what_is_lost(log, LogFormat::kCarmen), HasSubstr("nominal headings"));
  log.scans[0].reference_pose = Pose2{};
  EXPECT_THAT(what_is_lost(log, LogFormat::kRawlog), HasSubstr(", reference poses are left out"));
  EXPECT_EQ(what_is_lost(flaser_log(), LogFormat::kCarmen), "");
}

TEST(Convert, TextFormatsKeepEveryBit) {
  const TempFolder folder;
  const Log log = awkward_log();
  write_log(log, folder.path("a.nist"), LogFormat::kNist);
  const Log back = read_log(folder.path("a.nist"));
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    EXPECT_EQ(back.scans[i].timestamp_s, log.scans[i].timestamp_s);
    for (std::size_t s = 0; s < 4; ++s) {
      const Sweep& expected = log.scans[i].sweeps[s];
      for (std::size_t beam = 0; beam < expected.ranges_m.size(); ++beam) {
        const float read = back.scans[i].sweeps[s].ranges_m[beam];
        EXPECT_TRUE(read == expected.ranges_m[beam] || (beam == 1 && std::isnan(read))) << beam;
      }
    }
  }
}

TEST(Convert, ReferencePosesSurviveInTheTextFormat) {
  const TempFolder folder;
  Log log = flaser_log();
  log.scans[0].reference_pose = Pose2{1.5, -2.25, 0.5};
  write_log(log, folder.path("a.nist"), LogFormat::kNist);
  const Pose2 back = read_log(folder.path("a.nist")).scans.at(0).reference_pose.value();
  EXPECT_EQ(back.x_m, 1.5);
  EXPECT_EQ(back.y_m, -2.25);
  EXPECT_NEAR(back.theta_rad, 0.5, 1e-15);
}

TEST(Convert, WhatFlaserCanSayIsFlaser) {
  const TempFolder folder;
  const LogPoses poses{{{1.5, -2.5, 0.25}}};
  write_log(flaser_log(), folder.path("a.log"), LogFormat::kCarmen, &poses);
  const std::string content = test::read_file(folder.path("a.log"));
  EXPECT_THAT(content, HasSubstr("\nPARAM robot_front_laser_max 20 "));
  EXPECT_THAT(content, HasSubstr("\nFLASER 181 1 20 1.02 "));
  EXPECT_THAT(content, HasSubstr(" 1.5 -2.5 0.25 1.5 -2.5 0.25 12.5 shapemap 12.5\n"));
  expect_same_points(flaser_log(), read_log(folder.path("a.log")), 1e-9);
}

TEST(Convert, RobotLaserCarriesBothPoses) {
  const TempFolder folder;
  Log log = flaser_log();
  log.scans[0].sweeps[0].robot_from_sensor.x_m = 0.5;
  const LogPoses poses{{{1.0, 2.0, 90 * kDegree}}};
  write_log(log, folder.path("a.log"), LogFormat::kCarmen, &poses);
  const std::string content = test::read_file(folder.path("a.log"));
  EXPECT_THAT(content, HasSubstr("# shapemap mount 0.5 0 0 0 0 0\nROBOTLASER1 0 "));
  EXPECT_THAT(content, HasSubstr(" 0 1 2.5 1.5707963267948966 1 2 1.5707963267948966 0 0 0 0 0 12.5 "));
}

TEST(Convert, WrittenPosesAreNotReadBack) {
  const TempFolder folder;
  const LogPoses poses{{{1.0, 2.0, 0.5}, {-1e9, 2e9, 3.0}, {1e-300, 0.0, -3.0}}};
  for (const LogFormat format : {LogFormat::kRawlog, LogFormat::kCarmen}) {
    write_log(awkward_log(), folder.path("with"), format, &poses);
    write_log(awkward_log(), folder.path("without"), format);
    EXPECT_NE(test::read_gz(folder.path("with")), test::read_gz(folder.path("without")));
    expect_same_points(read_log(folder.path("with")), read_log(folder.path("without")), 1e-300);
  }
}

TEST(Convert, EndingGzCompressesTextFormats) {
  const TempFolder folder;
  write_log(flaser_log(), folder.path("a.nist.gz"), LogFormat::kNist);
  EXPECT_EQ(test::read_file(folder.path("a.nist.gz")).substr(0, 2), "\x1f\x8b");
  expect_same_points(flaser_log(), read_log(folder.path("a.nist.gz")), 1e-9);
}

TEST(Convert, SameLogSameBytes) {
  const TempFolder folder;
  for (const LogFormat format : kFormats) {
    write_log(awkward_log(), folder.path("a"), format);
    write_log(awkward_log(), folder.path("b"), format);
    EXPECT_EQ(test::read_file(folder.path("a")), test::read_file(folder.path("b"))) << enum_name(format);
  }
}

TEST(Convert, WhatCannotBeWrittenIsSaid) {
  const TempFolder folder;
  const LogPoses none;
  EXPECT_THROW(write_log(flaser_log(), folder.path("a"), LogFormat::kNist, &none), OutputError);
  EXPECT_THROW(write_log(flaser_log(), folder.path("a"), LogFormat::kAuto), OutputError);
  EXPECT_THROW(write_log(flaser_log(), folder.path("no/a"), LogFormat::kNist), OutputError);
  for (const LogFormat format : kFormats) EXPECT_THROW(write_log(awkward_log(), "/dev/full", format), OutputError);
  EXPECT_TRUE(folder.names().empty());
}

TEST(Summarise, CountsWhatTheLogHolds) {
  Log log = awkward_log();
  const LogSummary summary = summarise(log);
  EXPECT_EQ(summary.format, "nist");
  EXPECT_EQ(summary.num_scans, 3U);
  EXPECT_DOUBLE_EQ(summary.duration_s, 0.25);
  ASSERT_EQ(summary.sensors.size(), 2U);
  EXPECT_EQ(summary.sensors[0].label, "laser");
  EXPECT_EQ(summary.sensors[0].num_sweeps, 9U);
  EXPECT_EQ(summary.sensors[0].most_beams, 101U);
  EXPECT_NEAR(summary.sensors[0].fov_rad, 100 * kDegree, 1e-12);
  EXPECT_EQ(summary.sensors[0].max_range_m, 20.0);
  EXPECT_EQ(summary.sensors[0].shortest_return_m, 1.0);
  EXPECT_EQ(summary.sensors[0].longest_return_m, 20.0);  // the last sweep has no maximum
  EXPECT_DOUBLE_EQ(summary.sensors[0].return_ratio, (99.0 + 99.0 + 100.0) / 303.0);
  EXPECT_EQ(summarise(Log{}).num_scans, 0U);
}

}  // namespace
}  // namespace shapemap
