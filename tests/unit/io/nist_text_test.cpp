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

constexpr const char* kSensor = "sensor l beams 3 first_angle -50 angle_step 25 max_range 2000 min_range 10\n";

class NistText : public testing::Test {
 protected:
  Log read(const std::string& content, const LogReadOptions& options = {}) {
    return read_log(folder_.write("a.nist", content), LogFormat::kAuto, options);
  }
  std::string error(const std::string& content, const LogReadOptions& options = {}) {
    return input_error(folder_.write("a.nist", content), LogFormat::kAuto, options);
  }
  TempFolder folder_;
};

TEST_F(NistText, SaysAllThereIsToSay) {
  const Log log = read(
      "# remark\r\nshapemap-scans 1\r\nunits cm deg  # and so on\r\n\r\n"
      "sensor l beams 3 first_angle -50 angle_step 25 max_range 2000 min_range 10 "
      "mount 10 20 30 90 5 180\r\n"
      "position 1.5 reference 100 -200 90\r\nscan l heading 0 ranges 100 - 300\r\n"
      "scan l heading -90 ranges 110 nan 310\r\nposition 2\r\nscan l heading 0 ranges 1 2 3\r\n");
  EXPECT_EQ(log.format, "nist");
  EXPECT_TRUE(log.warnings.empty());
  ASSERT_EQ(log.scans.size(), 2U);
  const Scan& scan = log.scans[0];
  EXPECT_EQ(scan.timestamp_s, 1.5);
  EXPECT_EQ(scan.reference_pose, std::optional<Pose2>({1.0, -2.0, 90 * kDegree}));
  ASSERT_EQ(scan.sweeps.size(), 2U);
  const Sweep& sweep = scan.sweeps[1];
  EXPECT_FLOAT_EQ(sweep.ranges_m[0], 1.1F);
  EXPECT_TRUE(std::isnan(sweep.ranges_m[1]));
  EXPECT_DOUBLE_EQ(sweep.nominal_heading_rad, -90 * kDegree);
  EXPECT_DOUBLE_EQ(sweep.first_angle_rad, -50 * kDegree);
  EXPECT_DOUBLE_EQ(sweep.angle_step_rad, 25 * kDegree);
  EXPECT_DOUBLE_EQ(sweep.max_range_m, 20.0);
  EXPECT_DOUBLE_EQ(sweep.min_range_m, 0.1);
  EXPECT_DOUBLE_EQ(sweep.robot_from_sensor.x_m, 0.1);
  EXPECT_DOUBLE_EQ(sweep.robot_from_sensor.z_m, 0.3);
  EXPECT_DOUBLE_EQ(sweep.robot_from_sensor.yaw_rad, 90 * kDegree);
  EXPECT_DOUBLE_EQ(sweep.robot_from_sensor.pitch_rad, 5 * kDegree);
  EXPECT_DOUBLE_EQ(sweep.robot_from_sensor.roll_rad, kPi);
  EXPECT_FALSE(log.scans[1].reference_pose.has_value());
}

TEST_F(NistText, UnitsAreMetresAndDegreesUnlessSaid) {
  const std::string rest = "sensor l beams 2 first_angle 1 angle_step 0.5\nposition 0\nscan l heading 0 ranges 3 4\n";
  const Sweep sweep = read("shapemap-scans 1\n" + rest).scans.at(0).sweeps.at(0);
  EXPECT_EQ(sweep.ranges_m[0], 3.0F);
  EXPECT_DOUBLE_EQ(sweep.first_angle_rad, kDegree);
  EXPECT_EQ(sweep.max_range_m, 0.0);
  const Sweep in_mm = read("shapemap-scans 1\nunits mm rad\n" + rest).scans.at(0).sweeps.at(0);
  EXPECT_FLOAT_EQ(in_mm.ranges_m[0], 0.003F);
  EXPECT_EQ(in_mm.first_angle_rad, 1.0);
}

TEST_F(NistText, OneSensorCanBePicked) {
  const std::string content =
      "shapemap-scans 1\nsensor a beams 2 angle_step 1\nsensor b beams 2 angle_step 1\n"
      "position 0\nscan a heading 0 ranges 1 2\nscan b heading 0 ranges 3 4\n";
  EXPECT_EQ(read(content).scans.at(0).sweeps.size(), 2U);
  LogReadOptions options;
  options.sensor_label = "b";
  EXPECT_THAT(read(content, options).scans.at(0).sweeps.at(0).ranges_m, ElementsAre(3.0F, 4.0F));
  options.sensor_label = "c";
  EXPECT_THAT(error(content, options), HasSubstr("no scans of a laser called 'c'; the log has 'a' (1 scans), 'b'"));
}

TEST_F(NistText, FaultsAreNamedWithTheirLine) {
  const std::string head = "shapemap-scans 1\n";
  const std::string start = head + kSensor + "position 0\n";
  EXPECT_THAT(error("shapemap-scans 3\n"), HasSubstr("a.nist:1: version '3'"));
  EXPECT_THAT(error(head + "units inch deg\n"), HasSubstr("a.nist:2: unit of length is 'inch'"));
  EXPECT_THAT(error(head + "units m grad\n"), HasSubstr("a.nist:2: unit of angle is 'grad'"));
  EXPECT_THAT(error(head + kSensor + "units m deg\n"), HasSubstr("a.nist:3: units must come before"));
  EXPECT_THAT(error(head + kSensor + kSensor), HasSubstr("a.nist:3: sensor 'l' is declared twice"));
  EXPECT_THAT(error(head + "sensor l angle_step 3\n"), HasSubstr("a.nist:2: sensor 'l' has no 'beams'"));
  EXPECT_THAT(error(head + "sensor l fov 3\n"), HasSubstr("a.nist:2: 'fov' is no field of a sensor"));
  EXPECT_THAT(error(head + "position\n"), HasSubstr("a.nist:2: too few values: the timestamp"));
  EXPECT_THAT(error(head + "position 0 reference 1 2\n"), HasSubstr("a.nist:2: too few values: reference"));
  EXPECT_THAT(error(head + "position 0 0 0\n"), HasSubstr("a.nist:2: unexpected '0'"));
  EXPECT_THAT(error(head + kSensor + "scan l heading 0 ranges 1 2 3\n"), HasSubstr("a.nist:3: a scan before"));
  EXPECT_THAT(error(start + "scan k heading 0 ranges 1 2 3\n"), HasSubstr("a.nist:4: sensor 'k' is not declared"));
  EXPECT_THAT(error(start + "scan l heading 0 ranges 1 2\n"), HasSubstr("a.nist:4: too few values: 2 readings"));
  EXPECT_THAT(error(start + "scan l heading 0 ranges 1 2 3 4\n"), HasSubstr("a.nist:4: too many values"));
  EXPECT_THAT(error(start + "scan l heading x ranges 1 2 3\n"), HasSubstr("a.nist:4: heading is 'x'"));
  EXPECT_THAT(error(start + "scan l ranges 1 2 3\n"), HasSubstr("a.nist:4: expected 'heading'"));
  EXPECT_THAT(error(start + "scan l heading 0 ranges 1 x 3\n"), HasSubstr("a.nist:4: reading 2 is 'x'"));
  EXPECT_THAT(error(start + "skan l\n"), HasSubstr("a.nist:4: 'skan' is no statement"));
  EXPECT_THAT(error(start), HasSubstr("no 2D laser scans"));
}

TEST_F(NistText, ABillionBeamsThatAreNotThereAskForNoMemory) {
  EXPECT_THAT(error("shapemap-scans 1\nsensor l beams 1000000000 angle_step 1\nposition 0\n"
                    "scan l heading 0 ranges 1\n"),
              HasSubstr("a.nist:4: too few values: 1 readings, but sensor 'l' has 1000000000 beams"));
}

}  // namespace
}  // namespace shapemap
