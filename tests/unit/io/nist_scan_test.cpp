// SPDX-License-Identifier: GPL-3.0-or-later
// Version 2 of the text format states these things about sweeps, which version 1 could not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shapemap/scan/beam_angles.hpp"
#include "support/logs.hpp"
#include "support/temp_folder.hpp"

namespace shapemap {
namespace {

using test::input_error;
using test::TempFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class NistScan : public testing::Test {
 protected:
  Log read(const std::string& content) { return read_log(folder_.write("a.nist", "shapemap-scans 2\n" + content)); }
  std::string error(const std::string& content) {
    return input_error(folder_.write("a.nist", "shapemap-scans 2\n" + content));
  }
  TempFolder folder_;
};

TEST_F(NistScan, AScanHasItsOwnBeamsAnglesAndLimits) {
  const Log log = read(
      "sensor l beams any first_angle -90 angle_step 90 max_range 10 min_range 0.1\n"
      "position 0\nscan l heading 0 ranges 1 2 3\n"
      "position 1\nscan l heading 0 first_angle -45 angle_step 45 max_range inf min_range nan ranges 1 2\n"
      "position 2\nscan l heading 0 ranges\n"
      "position 3\nscan l heading 0 max_range 0 ranges 4 5 6 7\n");
  ASSERT_EQ(log.scans.size(), 4U);
  const auto sweep = [&](std::size_t i) { return log.scans[i].sweeps.at(0); };
  EXPECT_EQ(sweep(0).ranges_m.size(), 3U);
  EXPECT_EQ(sweep(0).max_range_m, 10.0);
  EXPECT_DOUBLE_EQ(sweep(1).first_angle_rad, -45 * kDegree);
  EXPECT_DOUBLE_EQ(sweep(1).angle_step_rad, 45 * kDegree);
  EXPECT_EQ(sweep(1).max_range_m, 0.0) << "not known";
  EXPECT_EQ(sweep(1).min_range_m, 0.0);
  EXPECT_THAT(sweep(2).ranges_m, IsEmpty());
  EXPECT_DOUBLE_EQ(sweep(3).first_angle_rad, -90 * kDegree) << "what a scan says holds for no other";
  EXPECT_EQ(sweep(3).max_range_m, 0.0);
}

TEST_F(NistScan, BeamsHaveAnglesTimesAndIntensitiesOfTheirOwn) {
  const Log log = read(
      "units m rad\nsensor l beams 3 angle_step 0.1 time_step 0.001\n"
      "position 7\nscan l heading 0 time 0.25 angles 0.5 0.1 0.3 ranges 1 2 3 intensities 10 20 nan\n"
      "position 8\nscan l heading 0 times 0.1 0.2 0.4 ranges 1 - 3\n");
  const Sweep& uneven = log.scans.at(0).sweeps.at(0);
  EXPECT_FALSE(uneven.is_evenly_spaced());
  EXPECT_THAT(uneven.beam_angles_rad, ElementsAre(0.5, 0.1, 0.3));
  EXPECT_DOUBLE_EQ(uneven.beam_time_s(2), 0.252);
  EXPECT_THAT(uneven.intensities, ElementsAre(10.0F, 20.0F, testing::NanSensitiveFloatEq(std::nanf(""))));
  const Sweep& even = log.scans.at(1).sweeps.at(0);
  EXPECT_TRUE(even.is_evenly_spaced());
  EXPECT_FLOAT_EQ(static_cast<float>(even.beam_time_s(2)), 0.4F);
}

TEST_F(NistScan, HeadersThatContradictThemselvesAreMendedAndCounted) {
  const Log log = read(
      "sensor l beams 3 first_angle -90 angle_step 1e9 last_angle 90\nposition 0\nscan l heading 0 ranges 1 2 3\n"
      "position 1\nscan l heading 0 angle_step -90 ranges 1 2 3\n"
      "position 2\nscan l heading 0 angle_step 10 ranges 1 2 3\n");
  EXPECT_DOUBLE_EQ(log.scans[0].sweeps[0].angle_step_rad, 90 * kDegree);
  EXPECT_DOUBLE_EQ(log.scans[1].sweeps[0].angle_step_rad, 90 * kDegree);
  EXPECT_DOUBLE_EQ(log.scans[2].sweeps[0].angle_step_rad, 10 * kDegree);
  EXPECT_THAT(log.warnings, ElementsAre(HasSubstr("1 scans have an angle_step and a last_angle that contradict"),
                                        HasSubstr("2 scans have an angle_step that cannot be")));
}

TEST_F(NistScan, WithImpossibleAnglesOfItsOwnIsLeftWithoutReadings) {
  const Log log = read(
      "sensor l beams any angle_step 1\nposition 0\nscan l heading 0 ranges 1 2\n"
      "position 1\nscan l heading 0 angle_step 0 last_angle nan ranges 1 2 intensities 1 2\n"
      "position 2\nscan l heading 0 first_angle nan ranges 1 2\n");
  ASSERT_EQ(log.scans.size(), 3U);
  EXPECT_EQ(log.scans[0].sweeps[0].ranges_m.size(), 2U);
  EXPECT_THAT(log.scans[1].sweeps[0].ranges_m, IsEmpty());
  EXPECT_THAT(log.scans[1].sweeps[0].intensities, IsEmpty());
  EXPECT_THAT(log.scans[2].sweeps[0].ranges_m, IsEmpty());
  EXPECT_THAT(log.warnings, ElementsAre(HasSubstr("2 scans have angles that cannot be")));
}

TEST_F(NistScan, FaultsAreNamedWithTheirLine) {
  const std::string start = "sensor l beams 3 first_angle -50 angle_step 25\nposition 0\nscan l heading 0 ";
  EXPECT_THAT(error("sensor l beams 3\nposition 0\nscan l heading 0 ranges 1 2 3\n"),
              HasSubstr("a.nist:4: neither angle_step nor last_angle says where the 3 beams point"));
  EXPECT_THAT(error("sensor l beams some\n"), HasSubstr("a.nist:2: beams is 'some', expected 1 or more, or 'any'"));
  EXPECT_THAT(error(start + "angles 1 2 ranges 1 2 3\n"), HasSubstr("a.nist:4: 2 angles for 3 readings"));
  EXPECT_THAT(error(start + "times 1 ranges 1 2 3\n"), HasSubstr("a.nist:4: 1 times for 3 readings"));
  EXPECT_THAT(error(start + "ranges 1 2 3 intensities 1\n"), HasSubstr("a.nist:4: 1 intensities for 3 readings"));
  EXPECT_THAT(error(start + "angles 1 x 3 ranges 1 2 3\n"), HasSubstr("a.nist:4: angle 2 is 'x'"));
  EXPECT_THAT(error(start + "time nan ranges 1 2 3\n"), HasSubstr("a.nist:4: time is 'nan', expected a number"));
  EXPECT_THAT(error(start + "angles 1 2 3\n"), HasSubstr("a.nist:4: expected 'ranges'"));
  EXPECT_THAT(error(start + "color 1 ranges 1 2 3\n"), HasSubstr("a.nist:4: 'color' is no field of a scan"));
}

TEST_F(NistScan, WhatIsWrittenReadsBackToTheSameBits) {
  Log log;
  for (int i = 0; i < 3; ++i) {
    Scan scan;
    scan.timestamp_s = i;
    Sweep sweep = test::make_sweep(static_cast<std::size_t>(5 + i), -0.1 - 0.01 * i, 0.013);
    sweep.beam_time_step_s = 1.0 / 7 / 360;
    sweep.start_s = 0.1 / 3 * i;
    sweep.nominal_heading_rad = 0.1 * i;
    if (i == 1) set_beam_angles(sweep, {0.1, 0.2 / 3, 0.3, 0.4, 0.5, 1.0 / 7});
    if (i == 2) sweep.intensities.assign(sweep.ranges_m.size(), 0.1F);
    if (i == 2) sweep.beam_times_s.assign(sweep.ranges_m.size(), 0.3F);
    scan.sweeps.push_back(std::move(sweep));
    log.scans.push_back(std::move(scan));
  }
  write_log(log, folder_.path("b.nist"), LogFormat::kNist);
  const Log back = read_log(folder_.path("b.nist"));
  EXPECT_THAT(back.warnings, IsEmpty());
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    SCOPED_TRACE(i);
    const Sweep& expected = log.scans[i].sweeps[0];
    const Sweep& read = back.scans.at(i).sweeps.at(0);
    EXPECT_EQ(read.beam_angles_rad, expected.beam_angles_rad);
    EXPECT_EQ(read.beam_times_s, expected.beam_times_s);
    EXPECT_EQ(read.intensities, expected.intensities);
    EXPECT_EQ(read.angle_step_rad, expected.angle_step_rad);
    EXPECT_EQ(read.first_angle_rad, expected.first_angle_rad);
    EXPECT_EQ(read.beam_time_step_s, expected.beam_time_step_s);
    EXPECT_EQ(read.start_s, expected.start_s);
    EXPECT_EQ(read.nominal_heading_rad, expected.nominal_heading_rad);
    EXPECT_EQ(read.ranges_m.size(), expected.ranges_m.size());
  }
}

TEST_F(NistScan, TheFirstVersionIsWrittenWhereItSuffices) {
  Log log;
  log.scans.emplace_back();
  log.scans[0].sweeps.push_back(test::make_sweep(5, 0.0, 0.1));
  write_log(log, folder_.path("a.nist"), LogFormat::kNist);
  EXPECT_THAT(test::read_file(folder_.path("a.nist")), HasSubstr("shapemap-scans 1\nunits m deg\n"));
  for (const LogFormat format : {LogFormat::kCarmen, LogFormat::kRawlog}) EXPECT_EQ(what_is_lost(log, format), "");
  Sweep& sweep = log.scans[0].sweeps[0];
  set_beam_angles(sweep, {0.0, 0.1, 0.2, 0.31, 0.4});
  sweep.intensities.assign(5, 1.0F);
  sweep.start_s = 1.0;
  EXPECT_THAT(what_is_lost(log, LogFormat::kRawlog),
              HasSubstr("nearest of evenly spaced beams, times of beams are left "
                        "out, intensities are left out"));
}

}  // namespace
}  // namespace shapemap
