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

LogReadOptions four_sweeps() {
  LogReadOptions options;
  options.fov_rad = 100 * kDegree;
  options.range_unit = RangeUnit::kCentimetre;
  options.sweeps_per_scan = 4;
  return options;
}

TEST(BareText, GeometryComesFromTheOptions) {
  const TempFolder folder;
  std::string content = "# a remark\n";
  for (int line = 0; line < 8; ++line) content += std::to_string(100 + line) + ", 200\t300  - 0\n\n";
  const Log log = read_log(folder.write("a.txt", content), LogFormat::kAuto, four_sweeps());
  EXPECT_EQ(log.format, "bare");
  EXPECT_TRUE(log.warnings.empty());
  ASSERT_EQ(log.scans.size(), 2U);
  EXPECT_EQ(log.scans[1].timestamp_s, 1.0);
  ASSERT_EQ(log.scans[1].sweeps.size(), 4U);
  const Sweep& sweep = log.scans[1].sweeps[1];
  EXPECT_FLOAT_EQ(sweep.ranges_m[0], 1.05F);
  EXPECT_EQ(sweep.ranges_m.size(), 5U);
  EXPECT_DOUBLE_EQ(sweep.first_angle_rad, -50 * kDegree);
  EXPECT_DOUBLE_EQ(sweep.angle_step_rad, 25 * kDegree);
  EXPECT_DOUBLE_EQ(sweep.nominal_heading_rad, 90 * kDegree);
  EXPECT_DOUBLE_EQ(log.scans[1].sweeps[3].nominal_heading_rad, -90 * kDegree);
  EXPECT_EQ(returns_in_robot(sweep, {}).size(), 3U);
}

TEST(BareText, AnIncompleteLastScanIsKeptWithAWarning) {
  const TempFolder folder;
  const Log log = read_log(folder.write("a.txt", "1 2\n1 2\n1 2\n1 2\n1 2\n"), LogFormat::kNist, four_sweeps());
  EXPECT_EQ(log.scans.size(), 2U);
  EXPECT_THAT(log.warnings, ElementsAre(HasSubstr("the last position has only 1 of 4 sub-scans")));
}

TEST(BareText, FaultsAreNamed) {
  const TempFolder folder;
  EXPECT_THAT(input_error(folder.write("a.txt", "1 2\n")), HasSubstr("--fov-deg"));
  const auto error = [&](const std::string& content) {
    return input_error(folder.write("a.txt", content), LogFormat::kAuto, four_sweeps());
  };
  EXPECT_THAT(error("1 2 3\n1 2\n"), HasSubstr("a.txt:2: 2 numbers, but the lines before have 3"));
  EXPECT_THAT(error("1 2 3\n1 x 3\n"), HasSubstr("a.txt:2: reading 2 is 'x'"));
  EXPECT_THAT(error("1\n"), HasSubstr("a.txt:1: one number"));
}

}  // namespace
}  // namespace shapemap
