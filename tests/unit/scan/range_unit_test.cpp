// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/scan/range_unit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/synthetic_world.hpp"

namespace shapemap {
namespace {

/// Walks through a cluttered room of some size; readings are in units of `metres_per_unit`, in whole numbers if asked.
Log walk(double size, double noise_m, double metres_per_unit, bool in_whole_numbers) {
  std::mt19937 rng(2);
  test::Scanner scanner;
  scanner.num_beams = 360;
  scanner.noise_m = noise_m;
  scanner.max_range_m = 1000.0;
  test::World world = test::uneven_room();
  for (auto& wall : world) {
    wall.start_m *= size;
    wall.end_m *= size;
  }
  Log log;
  for (int i = 0; i < 10; ++i) {
    Scan scan = test::scan_of(world, {0.02 * i * size, 0.01 * i * size, 0.1 * i}, scanner, rng);
    for (float& range : scan.sweeps[0].ranges_m) {
      const double value = range / metres_per_unit;
      range = static_cast<float>(in_whole_numbers ? std::round(value) : value);
    }
    scan.sweeps[0].max_range_m = 60.0;
    log.scans.push_back(std::move(scan));
  }
  return log;
}

TEST(RangeUnit, IsRecognisedFromTheReadings) {
  for (const double size : {0.6, 1.0, 3.0}) {
    for (const double noise_m : {0.003, 0.006, 0.01}) {
      SCOPED_TRACE(testing::Message() << "room times " << size << ", noise " << noise_m);
      EXPECT_EQ(recognised_range_unit(walk(size, noise_m, 1.0, false)), RangeUnit::kMetre);
      EXPECT_EQ(recognised_range_unit(walk(size, noise_m, 0.001, true)), RangeUnit::kMillimetre);
      EXPECT_EQ(recognised_range_unit(walk(size, noise_m, 0.01, true)), RangeUnit::kCentimetre);
    }
  }
}

TEST(RangeUnit, IsNotMistakenForACodeThatMostReadingsHave) {
  Log log = walk(1.0, 0.01, 1.0, false);
  for (Scan& scan : log.scans) {
    std::vector<float>& ranges_m = scan.sweeps[0].ranges_m;
    for (std::size_t i = 0; i < ranges_m.size(); ++i) {
      if (i % 10 != 0) ranges_m[i] = 900.0F;
    }
  }
  EXPECT_EQ(recognised_range_unit(log), RangeUnit::kMetre);
}

TEST(RangeUnit, OfALogWithoutReadingsIsTheMetre) {
  EXPECT_EQ(recognised_range_unit({}), RangeUnit::kMetre);
  Log log = walk(1.0, 0.01, 0.001, true);
  for (Scan& scan : log.scans) scan.sweeps[0].ranges_m.assign(5, std::nanf(""));
  EXPECT_EQ(recognised_range_unit(log), RangeUnit::kMetre);
}

TEST(RangeUnit, ScalesReadingsAndTheLimitsThatAreInTheSameUnit) {
  Log log = walk(1.0, 0.01, 0.001, true);
  const float before = log.scans[0].sweeps[0].ranges_m[0];
  log.scans[1].sweeps[0].max_range_m = 30000.0;
  log.scans[1].sweeps[0].min_range_m = 20.0;
  log.scans[2].sweeps[0].min_range_m = 0.1;
  scale_ranges(log, RangeUnit::kMillimetre);
  EXPECT_FLOAT_EQ(log.scans[0].sweeps[0].ranges_m[0], 0.001F * before);
  EXPECT_EQ(log.scans[0].sweeps[0].max_range_m, 60.0) << "already in metres";
  EXPECT_DOUBLE_EQ(log.scans[1].sweeps[0].max_range_m, 30.0);
  EXPECT_DOUBLE_EQ(log.scans[1].sweeps[0].min_range_m, 0.02);
  EXPECT_EQ(log.scans[2].sweeps[0].min_range_m, 0.1);
}

}  // namespace
}  // namespace shapemap
