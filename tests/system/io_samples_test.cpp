// SPDX-License-Identifier: GPL-3.0-or-later
// Real logs: the samples of Debian's mrpt-common, and the folder named by SHAPEMAP_DATASETS.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "support/logs.hpp"
#include "support/temp_folder.hpp"

namespace shapemap {
namespace {

const std::filesystem::path kSamples = "/usr/share/mrpt/datasets";

struct Sample {
  const char* name;
  std::size_t num_scans;
  std::size_t num_beams;
  double first_timestamp_s;
  double duration_s;
  double longest_return_m;
  double return_ratio;
};

class Samples : public testing::TestWithParam<Sample> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kSamples / GetParam().name)) GTEST_SKIP() << "needs Debian's package mrpt-common";
  }
};

TEST_P(Samples, AreReadWhole) {
  const Sample& expected = GetParam();
  const Log log = read_log((kSamples / expected.name).string());
  EXPECT_TRUE(log.warnings.empty());
  const LogSummary summary = summarise(log);
  EXPECT_EQ(summary.format, "rawlog");
  EXPECT_EQ(summary.num_scans, expected.num_scans);
  EXPECT_NEAR(log.scans.front().timestamp_s, expected.first_timestamp_s, 1e-6);
  EXPECT_NEAR(summary.duration_s, expected.duration_s, 1e-6);
  ASSERT_EQ(summary.sensors.size(), 1U);
  EXPECT_EQ(summary.sensors[0].num_sweeps, expected.num_scans);
  EXPECT_EQ(summary.sensors[0].most_beams, expected.num_beams);
  EXPECT_NEAR(summary.sensors[0].fov_rad, kPi, 1e-6);
  EXPECT_EQ(summary.sensors[0].max_range_m, 80.0);
  EXPECT_NEAR(summary.sensors[0].longest_return_m, expected.longest_return_m, 1e-4);
  EXPECT_NEAR(summary.sensors[0].return_ratio, expected.return_ratio, 1e-6);
}

TEST_P(Samples, StayThemselvesThroughEveryFormat) {
  const test::TempFolder folder;
  const Log log = read_log((kSamples / GetParam().name).string());
  for (const LogFormat format : {LogFormat::kRawlog, LogFormat::kCarmen, LogFormat::kNist}) {
    SCOPED_TRACE(enum_name(format));
    write_log(log, folder.path("out"), format);
    test::expect_same_points(log, read_log(folder.path("out")), 1e-4);  // up to 80 m, field of view as a float
  }
}

INSTANTIATE_TEST_SUITE_P(MrptCommon, Samples,
                         testing::Values(Sample{"2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog", 225, 361,
                                                1137834225.713386, 59.074946, 58.04, 0.885355},
                                         Sample{"localization_demo.rawlog", 37, 361, 1137772793.094853, 9.283349, 41.23,
                                                0.994235},
                                         Sample{"uwb_ro-localization_demo.rawlog", 343, 361, 1178275990.919835,
                                                363.152187, 13.91, 0.996624}));

struct CarmenSample {
  const char* name;
  std::size_t num_scans;
  std::size_t num_beams;
  double step_deg;
  double longest_return_m;
};

class CarmenSamples : public testing::TestWithParam<CarmenSample> {};

TEST_P(CarmenSamples, AreReadWhole) {
  const char* folder = std::getenv("SHAPEMAP_DATASETS");
  if (folder == nullptr) GTEST_SKIP() << "SHAPEMAP_DATASETS names no folder with real logs: nothing was tested";
  const CarmenSample& expected = GetParam();
  const std::filesystem::path path = std::filesystem::path(folder) / expected.name;
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is missing: nothing was tested";
  const Log log = read_log(path.string());
  // Some of these recordings have one time for all scans, and some times that were stamped late.
  EXPECT_THAT(log.warnings, testing::Each(testing::HasSubstr("timestamps")));
  EXPECT_LE(log.warnings.size(), 1U);
  const LogSummary summary = summarise(log);
  EXPECT_EQ(summary.format, "carmen");
  EXPECT_EQ(summary.num_scans, expected.num_scans);
  ASSERT_EQ(summary.sensors.size(), 1U);
  EXPECT_EQ(summary.sensors[0].most_beams, expected.num_beams);
  EXPECT_NEAR(summary.sensors[0].fov_rad, static_cast<double>(expected.num_beams - 1) * expected.step_deg * kDegree,
              1e-9);
  // Below each sensor's "no return" level, and not lower than its longest walls.
  EXPECT_NEAR(summary.sensors[0].longest_return_m, expected.longest_return_m, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Datasets, CarmenSamples,
                         testing::Values(CarmenSample{"carmen/aces-corrected.log.gz", 440, 180, 1.0, 49.91},
                                         CarmenSample{"carmen/belgioioso-corrected.log.gz", 395, 361, 0.5, 79.34},
                                         CarmenSample{"carmen/csail-corrected.log.gz", 406, 361, 0.5, 35.12},
                                         CarmenSample{"carmen/freiburg-079-corrected.log.gz", 4791, 360, 0.5, 36.62},
                                         CarmenSample{"carmen/intel-corrected.log.gz", 910, 180, 1.0, 25.38},
                                         CarmenSample{"carmen/orebro-corrected.log.gz", 237, 181, 1.0, 32.63},
                                         CarmenSample{"slam-benchmark/aces.clf.gz", 7374, 180, 1.0, 49.91},
                                         CarmenSample{"slam-benchmark/intel.clf.gz", 13631, 180, 1.0, 26.37},
                                         CarmenSample{"slam-benchmark/mit-csail.clf.gz", 1988, 361, 0.5, 42.4}));

TEST(BareSamples, AreReadWithTheirGeometryGiven) {
  const char* folder = std::getenv("SHAPEMAP_DATASETS");
  if (folder == nullptr) GTEST_SKIP() << "SHAPEMAP_DATASETS names no folder with real logs: nothing was tested";
  const std::filesystem::path path = std::filesystem::path(folder) / "short-range/tinyslam-exp1.dat.gz";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is missing: nothing was tested";
  EXPECT_THAT(test::input_error(path.string()), testing::HasSubstr("--fov-deg"));
  LogReadOptions options;
  options.fov_rad = 240 * kDegree;
  options.range_unit = RangeUnit::kMillimetre;
  EXPECT_EQ(read_log(path.string(), LogFormat::kAuto, options).scans.size(), 756U);
}

}  // namespace
}  // namespace shapemap
