// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/grid/scan_consistency.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "shapemap/core/errors.hpp"
#include "shapemap/mapper/map_log.hpp"
#include "support/random_graph.hpp"
#include "support/ring_walk.hpp"
#include "support/synthetic_world.hpp"

namespace shapemap {
namespace {

/// Scans of a world, and their poses in the map.
struct Mapped {
  std::vector<Scan> scans;
  std::vector<PlacedScan> placed;

  void add(const test::World& world, const Pose2& pose, const test::Scanner& scanner, std::mt19937& rng) {
    scans.push_back(test::scan_of(world, pose, scanner, rng));
    placed.push_back({placed.size(), 0.0, pose, {Pose2{}}});
  }
  std::vector<float>& ranges(std::size_t i) { return scans.at(i).sweeps.at(0).ranges_m; }
  std::vector<ScanConsistency> consistencies(const ConsistencyOptions& options = {}) const {
    return scan_consistencies(scans, placed, ReturnOptions{}, options);
  }
  std::vector<std::size_t> contradicting(const ConsistencyOptions& options = {}) const {
    std::vector<std::size_t> found;
    const std::vector<ScanConsistency> all = consistencies(options);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].contradicts_map) found.push_back(i);
    }
    return found;
  }
};

test::Scanner laser() {
  test::Scanner scanner;
  scanner.num_beams = 271;
  scanner.view_rad = 270 * kDegree;
  scanner.noise_m = 0.015;
  return scanner;
}

/// Scans a lap and a half of a corridor that runs round in a ring.
Mapped ring(unsigned seed, std::size_t count = 75) {
  const test::World world = test::ring_world(seed);
  std::mt19937 rng(seed);
  Mapped mapped;
  for (const Pose2& pose : test::ring_walk(count, seed)) mapped.add(world, pose, laser(), rng);
  return mapped;
}

using Indices = std::vector<std::size_t>;

TEST(ScanConsistency, NoScanOfARightMapContradictsIt) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Mapped mapped = ring(seed);
    EXPECT_EQ(mapped.contradicting(), Indices{}) << seed;
    for (const ScanConsistency& one : mapped.consistencies()) {
      EXPECT_GT(one.agree, 0.8);
      EXPECT_LE(one.known(), 1.0 + 1e-12);
    }
  }
}

TEST(ScanConsistency, NorWhenAllAreAFewCentimetresOff) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    Mapped mapped = ring(seed);
    std::mt19937 rng(seed + 100);
    std::normal_distribution<double> error(0.0, 0.05);
    for (PlacedScan& place : mapped.placed) {
      place.map_from_robot.x_m += error(rng);
      place.map_from_robot.y_m += error(rng);
      place.map_from_robot = place.map_from_robot * Pose2{0.0, 0.0, 10 * kDegree * error(rng)};
    }
    EXPECT_EQ(mapped.contradicting(), Indices{}) << seed;
  }
}

TEST(ScanConsistency, OneThatIsMovedOffItsPlaceDoesAndNoOther) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    Mapped mapped = ring(seed);
    const std::size_t moved = 10 + 5 * seed;
    // The scan is moved across the corridor, since along it the walls stay walls.
    PlacedScan& place = mapped.placed[moved];
    const Pose2 ahead = test::on_ring(test::kRingStep_m * static_cast<double>(moved));
    const Point2 across = rotate({0.0, seed % 2 == 0 ? 1.0 : -1.0}, ahead.theta_rad);
    place.map_from_robot.x_m += across.x();
    place.map_from_robot.y_m += across.y();
    place.map_from_robot = place.map_from_robot * Pose2{0.0, 0.0, 20 * kDegree};
    EXPECT_EQ(mapped.contradicting(), Indices{moved}) << seed;
  }
}

TEST(ScanConsistency, ItDoesNotMatterHowTheMapLies) {
  Mapped mapped = ring(3);
  mapped.placed[40].map_from_robot = mapped.placed[40].map_from_robot * Pose2{0.5, 0.9, 25 * kDegree};
  const Indices found = mapped.contradicting();
  EXPECT_EQ(found, Indices{40});
  for (const Pose2& map_from_old : {Pose2{-1000.3, 77.7, 0.0}, Pose2{0.03, 0.02, 1.0}, Pose2{3.0, -900.0, -2.5}}) {
    Mapped turned = mapped;
    for (PlacedScan& place : turned.placed) place.map_from_robot = map_from_old * place.map_from_robot;
    EXPECT_EQ(turned.contradicting(), found);
  }
}

/// Makes every longer beam of `from` to `to` end after `range_m`, as on the floor.
void cut_short(std::vector<float>& ranges, std::size_t from, std::size_t to, float range_m) {
  for (std::size_t b = from; b < to; ++b) ranges[b] = std::min(ranges[b], range_m);
}

TEST(ScanConsistency, BeamsThatEndInFreeSpaceOfOthersAreInFree) {
  Mapped mapped = ring(5);
  cut_short(mapped.ranges(30), 0, 271, 0.7F);
  const ScanConsistency one = mapped.consistencies()[30];
  EXPECT_TRUE(one.contradicts_map);
  EXPECT_GT(one.in_free, 0.5);
  EXPECT_LT(one.through, 0.05);
  EXPECT_EQ(mapped.contradicting(), Indices{30});
}

TEST(ScanConsistency, BeamsThatGoOnBehindWallsAreThrough) {
  Mapped mapped = ring(6);
  for (std::size_t b = 60; b < 210; ++b) mapped.ranges(30)[b] += 1.5F;
  const ScanConsistency one = mapped.consistencies()[30];
  EXPECT_TRUE(one.contradicts_map);
  EXPECT_GT(one.through, 0.3);
  EXPECT_LT(one.in_free, 0.15);
  EXPECT_EQ(mapped.contradicting(), Indices{30});
}

TEST(ScanConsistency, AFewBeamsThatMeetAPersonAreNoContradiction) {
  Mapped mapped = ring(7);
  cut_short(mapped.ranges(30), 120, 150, 0.6F);
  const ScanConsistency one = mapped.consistencies()[30];
  EXPECT_GT(one.in_free, 0.07);
  EXPECT_FALSE(one.contradicts_map);
  ConsistencyOptions strict;
  strict.contradicting_share = 0.05;
  EXPECT_TRUE(mapped.consistencies(strict)[30].contradicts_map);
}

TEST(ScanConsistency, WallsThatOthersSeeThroughAreNoWalls) {
  Mapped alone = ring(6);
  for (float& range_m : alone.ranges(30)) range_m += 1.5F;
  Mapped glass = ring(6);
  for (std::size_t i = 0; i < glass.scans.size(); i += 2) {
    for (float& range_m : glass.ranges(i)) range_m += 1.5F;
  }
  EXPECT_GT(alone.consistencies()[30].through, 0.5);
  EXPECT_LT(glass.consistencies()[30].through, 0.15);
}

TEST(ScanConsistency, LongGrazingBeamsThatAreALittleOffGoThroughNothing) {
  test::World corridor;
  test::add_polygon(corridor, {{0.0, -1.0}, {40.0, -1.0}, {40.0, 1.0}, {0.0, 1.0}});
  std::mt19937 rng(1);
  Mapped mapped;
  for (int i = 0; i < 30; ++i) {
    mapped.add(corridor, {2.0 + i, 0.2 * std::sin(i), 0.1 * std::cos(2.0 * i)}, laser(), rng);
    mapped.placed.back().map_from_robot.y_m += i % 2 == 0 ? 0.05 : -0.05;
  }
  for (const ScanConsistency& one : mapped.consistencies()) {
    EXPECT_LT(one.through, 0.08);
    EXPECT_FALSE(one.contradicts_map);
  }
}

TEST(ScanConsistency, ScansOfOneVisitAreNoEvidenceAboutEachOther) {
  const test::World world = test::uneven_room();
  std::mt19937 rng(1);
  Mapped mapped;
  for (int i = 0; i < 20; ++i) mapped.add(world, {0.01 * i, 0.0, 0.01 * i}, laser(), rng);
  for (const ScanConsistency& one : mapped.consistencies()) EXPECT_EQ(one.known(), 0.0);

  // Three scans from elsewhere outvote twenty that lean alike.
  for (std::size_t i = 0; i < 20; ++i) cut_short(mapped.ranges(i), 0, 271, 0.8F);
  for (const Pose2& pose : {Pose2{1.5, 0.0, 3.0}, Pose2{-1.5, 0.3, 0.1}, Pose2{0.3, 1.5, -1.5}}) {
    mapped.add(world, pose, laser(), rng);
  }
  Indices leaning(20);
  for (std::size_t i = 0; i < leaning.size(); ++i) leaning[i] = i;
  EXPECT_EQ(mapped.contradicting(), leaning);
}

TEST(ScanConsistency, ALonelyScanAndOneWithoutReturnsContradictNothing) {
  Mapped mapped = ring(8, 1);
  EXPECT_EQ(mapped.consistencies().at(0).known(), 0.0);
  for (float& range_m : mapped.ranges(0)) range_m = std::nanf("");
  EXPECT_EQ(mapped.consistencies().at(0).known(), 0.0);
  EXPECT_TRUE(Mapped{}.consistencies().empty());
}

TEST(ScanConsistency, PosesBeyondAnyMapAreLeftOut) {
  Mapped mapped = ring(9);
  mapped.placed[20].map_from_robot.x_m = std::numeric_limits<double>::quiet_NaN();
  mapped.placed[21].map_from_robot.x_m = 1e300;
  EXPECT_EQ(mapped.consistencies()[20].known(), 0.0);
  EXPECT_EQ(mapped.consistencies()[21].known(), 0.0);
  EXPECT_EQ(mapped.contradicting(), Indices{});
}

TEST(ScanConsistency, EachComponentIsJudgedByItself) {
  const Mapped mapped = ring(4);
  std::vector<Component> components(2);
  for (const PlacedScan& place : mapped.placed) components[place.scan_index % 2].scans.push_back(place);
  components[1].scans[10].map_from_robot = components[1].scans[10].map_from_robot * Pose2{0.4, 0.9, 0.4};
  judge_consistency(mapped.scans, {}, {}, components);
  for (std::size_t f = 0; f < 2; ++f) {
    const std::vector<ScanConsistency> alone = scan_consistencies(mapped.scans, components[f].scans, {}, {});
    for (std::size_t i = 0; i < alone.size(); ++i) {
      EXPECT_EQ(components[f].scans[i].consistency.agree, alone[i].agree);
      EXPECT_EQ(components[f].scans[i].consistency.contradicts_map, f == 1 && i == 10) << f << ", " << i;
    }
  }
}

TEST(ScanConsistency, BothMethodsJudgeTheirScans) {
  const test::World world = test::cluttered_room(2);
  std::mt19937 rng(2);
  Log log;
  for (int i = 0; i < 8; ++i) log.scans.push_back(test::scan_of(world, {-0.8 + 0.2 * i, 0.0, 0.02 * i}));
  MappingOptions robust;
  robust.robust.keyframes.step_m = 0.1;
  for (const MappingOptions& options : {robust, test::paper_options()}) {
    MappingEvents nobody;
    const MapResult result = map_log(log, options, nobody);
    ASSERT_EQ(result.placed().size(), log.scans.size());
    for (const PlacedScan& place : result.placed()) EXPECT_GT(place.consistency.agree, 0.7);
    EXPECT_GT(result.times.consistency_s, 0.0);
  }
}

TEST(ScanConsistency, RefusesLimitsThatAreNone) {
  ConsistencyOptions options;
  options.cell_m = 0.0;
  EXPECT_THROW(Mapped{}.consistencies(options), ConfigError);
}

}  // namespace
}  // namespace shapemap
