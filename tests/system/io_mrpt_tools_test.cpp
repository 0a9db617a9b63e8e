// SPDX-License-Identifier: GPL-3.0-or-later
// What MRPT's own programs make of our rawlogs, and we of theirs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <utility>
#include <vector>

#include "support/logs.hpp"
#include "support/temp_folder.hpp"

namespace shapemap {
namespace {

using test::expect_same_points;
using test::make_sweep;
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

Log four_sweeps() {
  Log log;
  for (int i = 0; i < 5; ++i) {
    Scan scan;
    scan.timestamp_s = 1000.5 + i;
    for (int turn = 0; turn < 4; ++turn) {
      scan.sweeps.push_back(make_sweep(401, -50 * kDegree, 0.25 * kDegree));
      scan.sweeps.back().nominal_heading_rad = turn * 90 * kDegree;
    }
    log.scans.push_back(scan);
  }
  return log;
}

TEST(MrptTools, RawlogEditOpensWhatWeWrite) {
  if (!is_installed("rawlog-edit")) GTEST_SKIP() << "needs rawlog-edit of Debian's package mrpt-apps";
  const TempFolder folder;
  const LogPoses poses{std::vector<Pose2>(5, Pose2{1.0, 2.0, 0.5})};
  for (const LogPoses* maybe_poses : {static_cast<const LogPoses*>(nullptr), &poses}) {
    const std::string path = folder.path("out.rawlog");
    write_log(four_sweeps(), path, LogFormat::kRawlog, maybe_poses);
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
  write_log(four_sweeps(), folder.path("out.rawlog"), LogFormat::kRawlog, &poses);
  const std::string shown = output_of(folder, "rawlog-edit --describe -i " + folder.path("out.rawlog"));
  EXPECT_THAT(shown, HasSubstr("CActionRobotMovement2D"));
}

/// carmen2rawlog of MRPT 2.5 does not keep a log's times: it gives all observations the moment at which it runs, or
/// nearly so. Times that say nothing become the index, and such that hardly differ may stay; the log's own take their
/// place.
void restore_timestamps(const Log& ours, Log& theirs) {
  ASSERT_EQ(ours.scans.size(), theirs.scans.size());
  for (std::size_t i = 1; i < ours.scans.size(); ++i) {
    EXPECT_GT(theirs.scans[i].timestamp_s, theirs.scans[i - 1].timestamp_s);
  }
  for (std::size_t i = 0; i < ours.scans.size(); ++i) {
    theirs.scans[i].timestamp_s = ours.scans[i].timestamp_s;
  }
}

Log carmen2rawlog(const TempFolder& folder, const std::string& log_path) {
  output_of(folder, "carmen2rawlog -q -w -i " + log_path + " -o " + folder.path("theirs.rawlog"));
  return read_log(folder.path("theirs.rawlog"));
}

/// carmen2rawlog makes observation-only rawlogs. MRPT's field of view lies symmetrically around the sensor's axis, so
/// that of ROBOTLASER1 lines only those can be equal that are symmetrical too.
TEST(MrptTools, Carmen2rawlogOfRobotLaserLinesIsReadBackEqual) {
  if (!is_installed("carmen2rawlog")) GTEST_SKIP() << "needs carmen2rawlog of Debian's package mrpt-apps";
  const TempFolder folder;
  Log log;
  for (int i = 0; i < 3; ++i) {
    Scan scan;
    scan.timestamp_s = 100.25 + i;
    scan.sweeps = {make_sweep(181, -90 * kDegree, kDegree)};
    scan.sweeps[0].max_range_m = 20.0 + i;  // no single maximum: cannot be FLASER
    log.scans.push_back(scan);
  }
  write_log(log, folder.path("in.log"), LogFormat::kCarmen);
  const Log ours = read_log(folder.path("in.log"));
  Log theirs = carmen2rawlog(folder, folder.path("in.log"));
  restore_timestamps(ours, theirs);
  ASSERT_EQ(ours.scans.at(0).sweeps.at(0).sensor_label, "ROBOTLASER1");
  EXPECT_EQ(theirs.scans.at(0).sweeps.at(0).sensor_label, "ROBOTLASER1");
  // 1e-4: MRPT keeps the field of view as a float.
  expect_same_points(ours, theirs, 1e-4);
}

/// Of FLASER lines, carmen2rawlog knows no convention of angles: it takes 0.5 degrees, or the parameter
/// laser_front_laser_resolution, times the number of beams as the angle from the first to the last beam, which is one
/// step more than there is. Readings, hits and the order of beams are the same; the angles must be MRPT's.
TEST(MrptTools, Carmen2rawlogOfFlaserLinesIsReadBackWithItsAngles) {
  if (!is_installed("carmen2rawlog")) GTEST_SKIP() << "needs carmen2rawlog of Debian's package mrpt-apps";
  const TempFolder folder;
  const std::array<std::pair<std::size_t, double>, 4> conventions{{{180, 1.0}, {181, 1.0}, {360, 0.5}, {361, 0.5}}};
  for (const auto& [num_beams, step_deg] : conventions) {
    SCOPED_TRACE(std::to_string(num_beams) + " beams");
    Log log;
    for (int i = 0; i < 3; ++i) {
      Scan scan;
      scan.timestamp_s = 100.25 + i;
      scan.sweeps = {make_sweep(num_beams, -90 * kDegree, step_deg * kDegree)};
      log.scans.push_back(scan);
    }
    write_log(log, folder.path("in.log"), LogFormat::kCarmen);
    const std::string resolution = "PARAM laser_front_laser_resolution " + std::to_string(step_deg) + " h 0\n";
    const std::string path = folder.write("in2.log", resolution + test::read_file(folder.path("in.log")));
    const Log ours = read_log(path);
    Log theirs = carmen2rawlog(folder, path);
    restore_timestamps(ours, theirs);
    ASSERT_EQ(ours.scans.size(), 3U);
    ASSERT_EQ(theirs.scans.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      const Sweep& our_scan = ours.scans[i].sweeps.at(0);
      const Sweep& their_scan = theirs.scans[i].sweeps.at(0);
      EXPECT_EQ(their_scan.sensor_label, "FLASER");
      EXPECT_EQ(their_scan.max_range_m, our_scan.max_range_m);
      const double aperture_rad = static_cast<double>(num_beams) * step_deg * kDegree;
      EXPECT_NEAR(their_scan.first_angle_rad, -aperture_rad / 2, 1e-6);
      EXPECT_NEAR(their_scan.angle_step_rad, aperture_rad / static_cast<double>(num_beams - 1), 1e-8);
      const std::vector<Return> our_hits = returns_in_robot(our_scan, {});
      const std::vector<Return> their_hits = returns_in_robot(their_scan, {});
      ASSERT_EQ(our_hits.size(), their_hits.size());
      for (std::size_t hit = 0; hit < our_hits.size(); ++hit) {
        EXPECT_EQ(our_hits[hit].beam, their_hits[hit].beam);
        EXPECT_EQ(our_hits[hit].range_m, their_hits[hit].range_m);
      }
    }
  }
}

}  // namespace
}  // namespace shapemap
