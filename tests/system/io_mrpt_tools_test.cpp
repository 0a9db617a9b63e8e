// SPDX-License-Identifier: GPL-3.0-or-later
// What MRPT's own programs make of our rawlogs, and we of theirs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "support/logs.hpp"
#include "support/temp_folder.hpp"

namespace shapemap {
namespace {

using test::expect_same_points;
using test::make_scan;
using test::TempFolder;
using testing::ContainsRegex;
using testing::HasSubstr;

bool is_installed(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

std::string output_of(const TempFolder& folder, const std::string& command) {
  const std::string shown = folder.path("shown.txt");
  EXPECT_EQ(std::system((command + " >" + shown + " 2>&1").c_str()), 0) << command;
  return test::read_file(shown);
}

Log four_sub_scans() {
  Log log;
  for (int i = 0; i < 5; ++i) {
    Position position;
    position.timestamp_s = 1000.5 + i;
    for (int turn = 0; turn < 4; ++turn) {
      position.sub_scans.push_back(make_scan(401, -50 * kDegree, 0.25 * kDegree));
      position.sub_scans.back().nominal_heading_rad = turn * 90 * kDegree;
    }
    log.positions.push_back(position);
  }
  return log;
}

TEST(MrptTools, RawlogEditOpensWhatWeWrite) {
  if (!is_installed("rawlog-edit")) GTEST_SKIP() << "needs rawlog-edit of Debian's package mrpt-apps";
  const TempFolder folder;
  const LogPoses poses{std::vector<Pose2>(5, Pose2{1.0, 2.0, 0.5})};
  for (const LogPoses* maybe_poses : {static_cast<const LogPoses*>(nullptr), &poses}) {
    const std::string path = folder.path("out.rawlog");
    write_log(four_sub_scans(), path, LogFormat::kRawlog, maybe_poses);
    const std::string shown = output_of(folder, "rawlog-edit --info -i " + path);
    EXPECT_THAT(shown, ContainsRegex("Overall number of objects +: 10"));  // an action and a frame per position
    EXPECT_THAT(shown, ContainsRegex("Actions/SensoryFrame format +: Yes"));
    EXPECT_THAT(shown, ContainsRegex("laser +/ +20 "));
    EXPECT_THAT(shown, ContainsRegex("Earliest timestamp +: 1000.500000"));
  }
}

TEST(MrptTools, RawlogEditSeesOurPosesAsOdometry) {
  if (!is_installed("rawlog-edit")) GTEST_SKIP() << "needs rawlog-edit of Debian's package mrpt-apps";
  const TempFolder folder;
  const LogPoses poses{{{1.0, 2.0, 0.5}, {1.5, 2.25, 0.5}, {2.0, 2.5, 0.5}, {2.5, 2.75, 0.5}, {3.0, 3.0, 0.5}}};
  write_log(four_sub_scans(), folder.path("out.rawlog"), LogFormat::kRawlog, &poses);
  const std::string shown = output_of(folder, "rawlog-edit --describe -i " + folder.path("out.rawlog"));
  EXPECT_THAT(shown, HasSubstr("CActionRobotMovement2D"));
}

/// carmen2rawlog makes observation-only rawlogs. Its ROBOTLASER1 fields are taken over as they are, but MRPT's field
/// of view lies symmetrically around the sensor's axis, so that only symmetrical lines can be equal.
TEST(MrptTools, Carmen2rawlogOfRobotLaserLinesIsReadBackEqual) {
  if (!is_installed("carmen2rawlog")) GTEST_SKIP() << "needs carmen2rawlog of Debian's package mrpt-apps";
  const TempFolder folder;
  Log log;
  for (int i = 0; i < 3; ++i) {
    Position position;
    position.timestamp_s = 100.25 + i;
    position.sub_scans = {make_scan(181, -90 * kDegree, kDegree)};
    position.sub_scans[0].max_range_m = 20.0 + i;  // no single maximum: cannot be FLASER
    log.positions.push_back(position);
  }
  write_log(log, folder.path("in.log"), LogFormat::kCarmen);
  output_of(folder, "carmen2rawlog -q -i " + folder.path("in.log") + " -o " + folder.path("out.rawlog"));
  const Log ours = read_log(folder.path("in.log"));
  const Log theirs = read_log(folder.path("out.rawlog"));
  ASSERT_EQ(ours.positions.at(0).sub_scans.at(0).sensor_label, "ROBOTLASER1");
  EXPECT_EQ(theirs.positions.at(0).sub_scans.at(0).sensor_label, "ROBOTLASER1");
  expect_same_points(ours, theirs, 1e-4);  // MRPT keeps the field of view as a float
}

}  // namespace
}  // namespace shapemap
