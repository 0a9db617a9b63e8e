// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/logs.hpp"
#include "support/temp_folder.hpp"

namespace shapemap {
namespace {

using test::input_error;
using test::TempFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

std::string readings(int count, const std::string& reading = "1.5") {
  std::string text = std::to_string(count);
  for (int i = 0; i < count; ++i) text += " " + reading;
  return text;
}

/// Returns only the readings, each with a blank in front.
std::string times(int count, const std::string& reading) {
  const std::string text = readings(count, reading);
  return text.substr(text.find(' '));
}

std::string flaser(int count, const std::string& reading = "1.5", const std::string& timestamp = "12.25") {
  return "FLASER " + readings(count, reading) + " 0 0 0 0 0 0 " + timestamp + " host 99\n";
}

class Carmen : public testing::Test {
 protected:
  Log read(const std::string& content, const LogReadOptions& options = {}) {
    return read_log(folder_.write("a.log", content), LogFormat::kAuto, options);
  }
  std::string error(const std::string& content, const LogReadOptions& options = {}) {
    return input_error(folder_.write("a.log", content), LogFormat::kAuto, options);
  }
  TempFolder folder_;
};

TEST_F(Carmen, FlaserAnglesFollowFromTheCount) {
  const std::array<std::tuple<int, double>, 4> conventions{{{180, 1.0}, {181, 1.0}, {360, 0.5}, {361, 0.5}}};
  for (const auto& [count, step_deg] : conventions) {
    const Log log = read(flaser(count));
    ASSERT_EQ(log.format, "carmen");
    ASSERT_EQ(log.scans.size(), 1U);
    EXPECT_EQ(log.scans[0].timestamp_s, 12.25);
    ASSERT_EQ(log.scans[0].sweeps.size(), 1U);
    const Sweep& sweep = log.scans[0].sweeps[0];
    EXPECT_EQ(sweep.ranges_m.size(), static_cast<std::size_t>(count));
    EXPECT_DOUBLE_EQ(sweep.first_angle_rad, -90 * kDegree);
    EXPECT_DOUBLE_EQ(sweep.angle_step_rad, step_deg * kDegree);
    EXPECT_EQ(sweep.sensor_label, "FLASER");
  }
}

TEST_F(Carmen, OtherCountsNeedAFieldOfView) {
  EXPECT_THAT(error("PARAM x 1\n" + flaser(100)), testing::AllOf(HasSubstr("a.log:2:"), HasSubstr("--fov-deg")));
  LogReadOptions options;
  options.fov_rad = 198 * kDegree;
  const Sweep sweep = read(flaser(100), options).scans[0].sweeps[0];
  EXPECT_DOUBLE_EQ(sweep.first_angle_rad, -99 * kDegree);
  EXPECT_DOUBLE_EQ(sweep.angle_step_rad, 2 * kDegree);
  EXPECT_DOUBLE_EQ(read(flaser(181), options).scans[0].sweeps[0].angle_step_rad, 1.1 * kDegree);
}

TEST_F(Carmen, RobotLaserHasItsOwnAnglesAndLimits) {
  const Log log = read("ROBOTLASER1 0 -1.0 2.0 0.5 7.5 0.1 0 5 1 2 3 7.5 8 2 10 20 l l l r r r 0 0 0 0 0 33.5 h 1\n");
  EXPECT_EQ(log.scans.at(0).timestamp_s, 33.5);
  const Sweep& sweep = log.scans[0].sweeps.at(0);
  EXPECT_EQ(sweep.first_angle_rad, -1.0);
  EXPECT_EQ(sweep.angle_step_rad, 0.5);
  EXPECT_EQ(sweep.max_range_m, 7.5);
  EXPECT_THAT(sweep.ranges_m, ElementsAre(1.0F, 2.0F, 3.0F, 7.5F, 8.0F));
  EXPECT_EQ(returns_in_robot(sweep, {}).size(), 3U);
}

TEST_F(Carmen, PosesAreNotEvenNumbers) {
  const Log log = read("FLASER " + readings(180) + " nan x ?? 1e999 -- # 7.5 host 1\n");
  EXPECT_EQ(log.scans.at(0).timestamp_s, 7.5);
}

TEST_F(Carmen, OtherKeywordsAreIgnored) {
  const Log log = read("# remark\nODOM garbage\nRLASER 5 junk\nSYNC\n\n" + flaser(180) + "TRUEPOS x\n");
  EXPECT_EQ(log.scans.size(), 1U);
  EXPECT_TRUE(log.warnings.empty());
}

TEST_F(Carmen, OneLaserIsUsedAndTheOthersAreNamed) {
  const std::string robot_laser = "ROBOTLASER1 0 -1 2 1 8 0 0 3 1 2 3 0 0 0 0 0 0 0 0 0 0 0 0 5 h 1\n";
  const Log first = read(flaser(180) + robot_laser);
  EXPECT_EQ(first.scans.size(), 1U);
  EXPECT_THAT(first.warnings, ElementsAre(HasSubstr("'ROBOTLASER1' (1 scans)")));
  LogReadOptions options;
  options.sensor_label = "ROBOTLASER1";
  const Log second = read(flaser(180) + robot_laser, options);
  EXPECT_EQ(second.scans.at(0).timestamp_s, 5.0);
  EXPECT_TRUE(second.warnings.empty());
  options.sensor_label = "none";
  EXPECT_THAT(error(flaser(180), options), testing::AllOf(HasSubstr("'none'"), HasSubstr("'FLASER'")));
}

TEST_F(Carmen, ReadingsThatAreNoDistancesAreNoReturns) {
  LogReadOptions options;
  options.fov_rad = 1.0;
  const Log log = read("FLASER 6 nan inf -1 0 2 -inf 0 0 0 0 0 0 1 h 1\n", options);
  const Sweep& sweep = log.scans.at(0).sweeps.at(0);
  EXPECT_EQ(returns_in_robot(sweep, {}).size(), 1U);
  for (const std::size_t beam : {0U, 1U}) EXPECT_TRUE(std::isnan(sweep.ranges_m[beam])) << beam;
  for (const std::size_t beam : {2U, 3U, 5U}) EXPECT_EQ(sweep.ranges_m[beam], 0.0F) << "says nothing: " << beam;
}

TEST_F(Carmen, ALineWithoutReadingsIsAnEmptyScan) {
  const Log log = read(flaser(180) + "FLASER 0 0 0 0 0 0 0 9 h 9\n");
  ASSERT_EQ(log.scans.size(), 2U);
  EXPECT_TRUE(log.scans[1].sweeps.at(0).ranges_m.empty());
}

TEST_F(Carmen, SickErrorCodesAreNoReturns) {
  const Sweep sweep =
      read("FLASER 180 81.91 80.5" + times(178, "1.5") + " 0 0 0 0 0 0 1 h 1\n").scans.at(0).sweeps.at(0);
  EXPECT_FLOAT_EQ(static_cast<float>(sweep.max_range_m), 81.91F);
  EXPECT_EQ(returns_in_robot(sweep, {}).size(), 179U);
}

TEST_F(Carmen, SickCodesInMillimetresAreNoReturns) {
  const Log log =
      read("FLASER 180" + times(160, "3.21") + times(10, "32.763") + times(10, "32.767") + " 0 0 0 0 0 0 1 h 1\n");
  EXPECT_FLOAT_EQ(static_cast<float>(log.scans.at(0).sweeps.at(0).max_range_m), 32.763F);
  EXPECT_EQ(returns_in_robot(log.scans[0].sweeps[0], {}).size(), 160U);
}

TEST_F(Carmen, AParameterLimitsTheRange) {
  const Log log = read("PARAM robot_front_laser_max 10.0 host 1\n" + flaser(180, "10.5"));
  EXPECT_EQ(log.scans.at(0).sweeps.at(0).max_range_m, 10.0);
  EXPECT_TRUE(returns_in_robot(log.scans[0].sweeps[0], {}).empty());
}

TEST_F(Carmen, ShortLinesAreNamed) {
  EXPECT_THAT(error(flaser(180) + "FLASER 180 1 2 3\n"), HasSubstr("a.log:2: too few values"));
  EXPECT_THAT(error("FLASER\n"), HasSubstr("a.log:1: '' where the number of readings"));
  EXPECT_THAT(error("FLASER " + readings(180) + " 0 0 0\n"), HasSubstr("a.log:1: too few values"));
  EXPECT_THAT(error("FLASER " + readings(180) + " 0 0 0 0 0 0\n"), HasSubstr("a.log:1: too few values: the timestamp"));
  EXPECT_THAT(error(flaser(180, "1.5", "nan")), HasSubstr("a.log:1: the timestamp is 'nan'"));
  EXPECT_THAT(error(flaser(180, "1.5x")), HasSubstr("a.log:1: reading 1 is '1.5x'"));
  EXPECT_THAT(error("ROBOTLASER1 0 -1 2\n"), HasSubstr("a.log:1: too few values: the angular resolution"));
}

TEST_F(Carmen, ABillionBeamsAreNotBelieved) {
  EXPECT_THAT(error("FLASER 1000000000 1 2 3\n"), HasSubstr("announces 1000000000 readings but has only 3"));
  EXPECT_THAT(error("FLASER 99999999999999999999 1 2 3\n"), HasSubstr("a.log:1:"));
  EXPECT_THAT(error("ROBOTLASER1 0 -1 2 1 8 0 0 3 1 2 3 1000000000 0\n"), HasSubstr("1000000000 remissions"));
  EXPECT_THAT(error("FLASER -5 1 2 3\n"), HasSubstr("'-5' where the number of readings"));
}

TEST_F(Carmen, DosLineEndsAndALastLineWithoutEnd) {
  std::string content = flaser(180) + flaser(180, "2.5", "13");
  content.insert(content.size() - 1, "\r");
  content.pop_back();
  EXPECT_EQ(read(content).scans.size(), 2U);
}

}  // namespace
}  // namespace shapemap
