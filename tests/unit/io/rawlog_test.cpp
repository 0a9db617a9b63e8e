// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/core/Clock.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include "support/logs.hpp"
#include "support/temp_folder.hpp"

namespace shapemap {
namespace {

using mrpt::obs::CObservation2DRangeScan;
using test::TempFolder;
using testing::ElementsAre;
using testing::HasSubstr;

CObservation2DRangeScan::Ptr mrpt_scan(const std::string& label, double timestamp_s) {
  auto scan = CObservation2DRangeScan::Create();
  scan->sensorLabel = label;
  scan->timestamp = mrpt::Clock::fromDouble(timestamp_s);
  scan->aperture = 2.0F;
  scan->maxRange = 10.0F;
  scan->resizeScanAndAssign(5, 3.0F, true);
  scan->setScanRange(1, 10.0F);
  scan->setScanRangeValidity(2, false);
  return scan;
}

/// The objects follow each other, as MRPT writes them into rawlogs.
class Rawlog : public testing::Test {
 protected:
  template <class... Objects>
  Log read(const Objects&... objects) {
    {
      mrpt::io::CFileGZOutputStream file(path_);
      auto archive = mrpt::serialization::archiveFrom(file);
      ((archive << objects), ...);
    }
    return read_log(path_, LogFormat::kAuto, options_);
  }
  static mrpt::obs::CSensoryFrame frame(std::initializer_list<mrpt::obs::CObservation::Ptr> observations) {
    mrpt::obs::CSensoryFrame out;
    for (const auto& observation : observations) out.insert(observation);
    return out;
  }

  TempFolder folder_;
  std::string path_ = folder_.path("a.rawlog");
  LogReadOptions options_;
};

TEST_F(Rawlog, ObservationsOfAFrameAreSweepsOfOneScan) {
  auto comment = mrpt::obs::CObservationComment::Create();
  comment->text = "\x88\x88 not the end";
  const Log log = read(mrpt::obs::CActionCollection(), frame({mrpt_scan("a", 5.5), comment, mrpt_scan("b", 6.0)}),
                       mrpt::obs::CActionCollection(), frame({comment}), frame({}), mrpt::obs::CActionCollection(),
                       frame({comment, mrpt_scan("a", 7.0), comment}));
  EXPECT_EQ(log.format, "rawlog");
  EXPECT_TRUE(log.warnings.empty());
  ASSERT_EQ(log.scans.size(), 2U);
  EXPECT_EQ(log.scans[0].timestamp_s, 5.5);
  ASSERT_EQ(log.scans[0].sweeps.size(), 2U);
  EXPECT_EQ(log.scans[0].sweeps[1].sensor_label, "b");
  EXPECT_EQ(log.scans[1].timestamp_s, 7.0);
}

TEST_F(Rawlog, LoneObservationsAreOneScanEachOfTheFirstLaser) {
  mrpt::obs::CObservationOdometry odometry;
  const Log log = read(odometry, *mrpt_scan("front", 1.0), odometry, *mrpt_scan("rear", 1.5), *mrpt_scan("front", 2.0));
  ASSERT_EQ(log.scans.size(), 2U);
  EXPECT_EQ(log.scans[1].timestamp_s, 2.0);
  EXPECT_THAT(log.warnings, ElementsAre(testing::AllOf(HasSubstr("'front'"), HasSubstr("'rear' (1 scans)"))));
}

TEST_F(Rawlog, ALaserCanBePicked) {
  options_.sensor_label = "rear";
  EXPECT_EQ(read(*mrpt_scan("front", 1.0), *mrpt_scan("rear", 1.5)).scans.at(0).timestamp_s, 1.5);
  EXPECT_EQ(read(frame({mrpt_scan("front", 1.0), mrpt_scan("rear", 1.5)})).scans.at(0).sweeps.size(), 1U);
  options_.sensor_label = "top";
  EXPECT_THROW(read(*mrpt_scan("front", 1.0)), InputError);
}

TEST_F(Rawlog, AnglesMountFlagsAndLimitsAreKept) {
  auto scan = mrpt_scan("a", 1.0);
  scan->rightToLeft = false;
  scan->sensorPose.setFromValues(0.1, 0.2, 0.3, 0.5, 0.25, 3.0);
  const Sweep out = read(frame({scan})).scans.at(0).sweeps.at(0);
  EXPECT_DOUBLE_EQ(out.first_angle_rad, 1.0);
  EXPECT_DOUBLE_EQ(out.angle_step_rad, -0.5);
  EXPECT_EQ(out.max_range_m, 10.0);
  EXPECT_EQ(out.ranges_m[0], 3.0F);
  EXPECT_EQ(out.ranges_m[1], 10.0F);
  EXPECT_TRUE(std::isnan(out.ranges_m[2]));
  EXPECT_DOUBLE_EQ(out.robot_from_sensor.x_m, 0.1);
  EXPECT_DOUBLE_EQ(out.robot_from_sensor.z_m, 0.3);
  EXPECT_NEAR(out.robot_from_sensor.yaw_rad, 0.5, 1e-12);
  EXPECT_NEAR(out.robot_from_sensor.pitch_rad, 0.25, 1e-12);
  EXPECT_NEAR(out.robot_from_sensor.roll_rad, 3.0, 1e-12);
  EXPECT_EQ(out.nominal_heading_rad, 0.0);
  EXPECT_EQ(returns_in_robot(out, {}).size(), 3U);
}

TEST_F(Rawlog, AScanWithoutTimeTakesItsIndex) {
  auto scan = mrpt_scan("a", 1.0);
  scan->timestamp = INVALID_TIMESTAMP;
  const Log log = read(*scan, *scan);
  EXPECT_EQ(log.scans.at(1).timestamp_s, 1.0);
  EXPECT_THAT(log.warnings, ElementsAre(HasSubstr("2 positions have no timestamp")));
}

TEST_F(Rawlog, AScanWithoutBeamsIsLeftOut) {
  auto scan = mrpt_scan("a", 1.0);
  scan->resizeScan(0);
  const Log log = read(*scan, *mrpt_scan("a", 2.0));
  EXPECT_EQ(log.scans.size(), 1U);
  EXPECT_THAT(log.warnings, ElementsAre(HasSubstr("1 scan is left out: no beams (the first at offset ")));
}

TEST_F(Rawlog, WithoutLasersSaysSo) { EXPECT_THROW(read(mrpt::obs::CActionCollection(), frame({})), InputError); }

}  // namespace
}  // namespace shapemap
