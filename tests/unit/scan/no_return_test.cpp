// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/scan/no_return.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "shapemap/core/errors.hpp"
#include "shapemap/scan/joined_logs.hpp"
#include "shapemap/scan/returns.hpp"
#include "support/synthetic_world.hpp"

namespace shapemap {
namespace {

using test::Scanner;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr float kLost = -1.0F;
constexpr double kSeen_m = 4.0;

Pose2 driving(int i) { return {1.1 * std::cos(0.5 * i), 0.9 * std::sin(0.37 * i), 0.3 * i}; }

/// Takes sweeps of one laser in a room full of boxes; readings farther than `seen_m` are kLost. The log states no
/// maximum.
Log sweeps(int count, const std::function<Pose2(int)>& world_from_robot = driving, double seen_m = kSeen_m,
           double noise_m = 0.01) {
  const test::World world = test::cluttered_room(3);
  std::mt19937 rng(5);
  Scanner scanner;
  scanner.num_beams = 180;
  scanner.noise_m = noise_m;
  scanner.max_range_m = seen_m;
  Log log;
  for (int i = 0; i < count; ++i) {
    log.scans.push_back(test::scan_of(world, world_from_robot(i), scanner, rng));
    Sweep& sweep = log.scans.back().sweeps.front();
    sweep.max_range_m = 0.0;
    sweep.sensor_label = "laser";
    for (float& range_m : sweep.ranges_m) {
      range_m = std::round(range_m * 100.0F) / 100.0F;
      if (range_m >= static_cast<float>(seen_m)) range_m = kLost;
    }
  }
  return log;
}

using Code = std::function<double(int)>;  ///< takes the number of the sweep

/// Gives lost readings a distance, and returns how many there are.
std::size_t say_lost(Log& log, const Code& code_m) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    for (Sweep& sweep : log.scans[i].sweeps) {
      for (float& range_m : sweep.ranges_m) {
        if (range_m != kLost) continue;
        range_m = static_cast<float>(code_m(static_cast<int>(i)));
        ++count;
      }
    }
  }
  return count;
}

std::size_t num_hits(const Log& log) {
  std::size_t count = 0;
  for (const Scan& scan : log.scans) {
    for (const Sweep& sweep : scan.sweeps) count += returns_in_robot(sweep, {}).size();
  }
  return count;
}

std::size_t num_seen(const Log& log) {
  std::size_t count = 0;
  for (const Scan& scan : log.scans) {
    for (const float range_m : scan.sweeps.front().ranges_m) count += range_m != kLost ? 1 : 0;
  }
  return count;
}

void expect_level(const NoReturnLevel& level, double from_m, double to_m, std::size_t num_readings) {
  EXPECT_FLOAT_EQ(static_cast<float>(level.from_m), static_cast<float>(from_m));
  EXPECT_FLOAT_EQ(static_cast<float>(level.to_m), static_cast<float>(to_m));
  EXPECT_EQ(level.num_readings, num_readings);
}

TEST(NoReturn, ALevelAtTheTopIsTheMaximum) {
  for (const double code_m : {kSeen_m, 4.07, 51.15, 65.533, 81.91}) {
    Log log = sweeps(60);
    const std::size_t seen = num_seen(log);
    const std::size_t lost = say_lost(log, [&](int) { return code_m; });
    sort_out_no_returns(log, {});
    ASSERT_THAT(log.no_returns, SizeIs(1)) << code_m;
    expect_level(log.no_returns[0], code_m, code_m, lost);
    EXPECT_EQ(log.no_returns[0].sensor_label, "laser");
    EXPECT_FLOAT_EQ(static_cast<float>(log.scans[9].sweeps[0].max_range_m), static_cast<float>(code_m));
    EXPECT_EQ(num_hits(log), seen);
  }
}

TEST(NoReturn, OnALevelAmongTheReadingsOnlyItsReadingsGo) {
  for (const double code_m : {0.001, 0.02, 2.0, 3.333}) {
    Log log = sweeps(120);
    const std::size_t seen = num_seen(log);
    const std::size_t lost = say_lost(log, [&](int) { return code_m; });
    sort_out_no_returns(log, {});
    ASSERT_THAT(log.no_returns, SizeIs(1)) << code_m;
    EXPECT_FLOAT_EQ(static_cast<float>(log.no_returns[0].from_m), static_cast<float>(code_m));
    EXPECT_FLOAT_EQ(static_cast<float>(log.no_returns[0].to_m), static_cast<float>(code_m));
    EXPECT_GE(log.no_returns[0].num_readings, lost);
    EXPECT_EQ(log.scans[9].sweeps[0].max_range_m, 0.0);
    EXPECT_LE(num_hits(log), seen);
    EXPECT_GT(num_hits(log), seen * 99 / 100);  // some surfaces are just as far
  }
}

TEST(NoReturn, ASpreadLevelIsTakenWholeAndNoWider) {
  Log log = sweeps(60);
  int turn = 0;
  const std::size_t lost = say_lost(log, [&](int) { return 51.0 + 0.05 * (turn++ % 5); });
  log.scans[3].sweeps[0].ranges_m[4] = 50.7F;
  sort_out_no_returns(log, {});
  ASSERT_THAT(log.no_returns, SizeIs(1));
  EXPECT_NEAR(log.no_returns[0].from_m, 51.0, 1e-5);
  EXPECT_NEAR(log.no_returns[0].to_m, 51.2, 1e-5);
  EXPECT_NEAR(static_cast<double>(log.no_returns[0].num_readings), static_cast<double>(lost), 1.0);
}

TEST(NoReturn, OddReadingsBeyondALevelAreNoneEither) {
  Log log = sweeps(60);
  const std::size_t seen = num_seen(log);
  int turn = 0;
  say_lost(log, [&](int) { return ++turn % 40 == 0 ? 55.0 + 0.37 * (turn % 97) : 51.15; });
  log.scans[3].sweeps[0].ranges_m[50] = 77.7F;
  const std::size_t hits_before = seen;
  sort_out_no_returns(log, {});
  ASSERT_FALSE(log.no_returns.empty());
  EXPECT_FLOAT_EQ(static_cast<float>(log.no_returns[0].from_m), 51.15F);
  EXPECT_LE(num_hits(log), hits_before);
}

TEST(NoReturn, ALevelMayChangeBetweenSessions) {
  Log log = sweeps(120);
  const std::size_t seen = num_seen(log);
  say_lost(log, [](int i) { return i < 60 ? 50.0 : 51.15; });
  sort_out_no_returns(log, {});
  ASSERT_THAT(log.no_returns, SizeIs(2));
  EXPECT_FLOAT_EQ(static_cast<float>(log.no_returns[0].from_m), 50.0F);
  EXPECT_FLOAT_EQ(static_cast<float>(log.no_returns[1].from_m), 51.15F);
  EXPECT_EQ(num_hits(log), seen);
}

TEST(NoReturn, EachSensorHasItsOwn) {
  Log log = sweeps(60);
  Log rear = sweeps(60);
  say_lost(log, [](int) { return 9.0; });
  say_lost(rear, [](int) { return 12.34; });
  for (std::size_t i = 0; i < 60; ++i) {
    log.scans[i].sweeps.push_back(rear.scans[i].sweeps[0]);
    log.scans[i].sweeps[1].sensor_label = "rear";
  }
  sort_out_no_returns(log, {});
  ASSERT_THAT(log.no_returns, SizeIs(2));
  EXPECT_EQ(log.no_returns[1].sensor_label, "rear");
  EXPECT_FLOAT_EQ(static_cast<float>(log.scans[0].sweeps[0].max_range_m), 9.0F);
  EXPECT_FLOAT_EQ(static_cast<float>(log.scans[0].sweeps[1].max_range_m), 12.34F);
}

TEST(NoReturn, AHeaderDoesNotOverruleSurfacesFarBeyondIt) {
  Log log = sweeps(60);
  const std::size_t seen = num_seen(log);
  say_lost(log, [](int) { return 51.15; });
  for (Scan& scan : log.scans) scan.sweeps[0].max_range_m = 1.5;
  sort_out_no_returns(log, {});
  EXPECT_THAT(log.warnings, ElementsAre(HasSubstr("maximum range of 1.5 m")));
  EXPECT_FLOAT_EQ(static_cast<float>(log.scans[0].sweeps[0].max_range_m), 51.15F);
  EXPECT_EQ(num_hits(log), seen);
}

TEST(NoReturn, AHeaderWithNothingBeyondItHolds) {
  Log log = sweeps(60);
  say_lost(log, [](int) { return 4.3; });
  for (Scan& scan : log.scans) scan.sweeps[0].max_range_m = 3.9;
  sort_out_no_returns(log, {});
  EXPECT_THAT(log.warnings, IsEmpty());
  EXPECT_EQ(log.scans[0].sweeps[0].max_range_m, 3.9);
}

TEST(NoReturn, SurfacesAreNoLevels) {
  const auto standing = [](int) { return Pose2{0.3, 0.2, 0.1}; };
  const auto turning = [](int i) { return Pose2{0.3, 0.2, 0.07 * i}; };
  const auto along_wall = [](int i) { return Pose2{-1.5 + 0.02 * i, -1.0, 0.0}; };
  for (const auto& motion : std::vector<std::function<Pose2(int)>>{driving, standing, turning, along_wall}) {
    for (const double noise_m : {0.001, 0.05}) {
      Log log = sweeps(150, motion, 100.0, noise_m);
      sort_out_no_returns(log, {});
      EXPECT_THAT(log.no_returns, IsEmpty());
      EXPECT_EQ(log.scans[0].sweeps[0].max_range_m, 0.0);
    }
  }
}

TEST(NoReturn, CoarseReadingsAndLostBeamsAreNoLevels) {
  Log log = sweeps(150, driving, 100.0);
  std::mt19937 rng(1);
  for (Scan& scan : log.scans) {
    for (float& range_m : scan.sweeps[0].ranges_m) {
      range_m = rng() % 2 == 0 ? std::numeric_limits<float>::quiet_NaN() : std::round(range_m * 20.0F) / 20.0F;
    }
  }
  sort_out_no_returns(log, {});
  EXPECT_THAT(log.no_returns, IsEmpty());
}

TEST(NoReturn, NothingIsSaidOfALogThatIsTooShort) {
  Log log = sweeps(2);
  say_lost(log, [](int) { return 9.0; });
  sort_out_no_returns(log, {});
  EXPECT_THAT(log.no_returns, IsEmpty());
  EXPECT_THAT(log.warnings, IsEmpty());
}

TEST(NoReturn, ErrorCodesOfSickAreKnown) {
  for (const double code_m : {81.83, 32.763}) {
    Log log = sweeps(2);
    const std::size_t seen = num_seen(log);
    say_lost(log, [&](int) { return code_m; });
    sort_out_no_returns(log, {});
    EXPECT_THAT(log.no_returns, IsEmpty());
    EXPECT_EQ(num_hits(log), seen);
  }
}

TEST(NoReturn, TheUserHasTheLastWord) {
  const Log learned = [] {
    Log log = sweeps(60);
    say_lost(log, [](int) { return 51.15; });
    return log;
  }();
  Log none = learned;
  sort_out_no_returns(none, no_return_choice("none"));
  EXPECT_THAT(none.no_returns, IsEmpty());
  EXPECT_EQ(none.scans[0].sweeps[0].max_range_m, 0.0);

  Log given = learned;
  sort_out_no_returns(given, no_return_choice("1.5-1.6,51.15"));
  ASSERT_THAT(given.no_returns, SizeIs(2));
  EXPECT_GE(given.no_returns[0].from_m, 1.4995);
  EXPECT_LE(given.no_returns[0].to_m, 1.6005);
  EXPECT_FLOAT_EQ(static_cast<float>(given.scans[0].sweeps[0].max_range_m), 51.15F);
}

TEST(NoReturn, AChoiceThatMakesNoSenseIsAnError) {
  EXPECT_TRUE(no_return_choice("auto").is_learned);
  for (const char* text : {"", "x", "51.15,", "-3", "0", "51.2-51.0", "nan", "1 2", "2000", "1-2-3"}) {
    EXPECT_THROW(no_return_choice(text), ConfigError) << text;
  }
}

TEST(NoReturn, JoinedLogsKeepWhatWasLearnedOfEach) {
  Log first = sweeps(60);
  Log second = sweeps(60);
  say_lost(first, [](int) { return 9.0; });
  say_lost(second, [](int) { return 12.34; });
  sort_out_no_returns(first, {});
  sort_out_no_returns(second, {});
  const Log joined = joined_logs({first, second});
  ASSERT_THAT(joined.no_returns, SizeIs(2));
  EXPECT_EQ(joined.no_returns[0].log, 0U);
  EXPECT_EQ(joined.no_returns[1].log, 1U);
  EXPECT_FLOAT_EQ(static_cast<float>(joined.no_returns[1].from_m), 12.34F);
}

}  // namespace
}  // namespace shapemap
