// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/paper/paper_mapper.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <stdexcept>

#include "shapemap/core/errors.hpp"
#include "support/matchers.hpp"
#include "support/synthetic_world.hpp"

namespace shapemap {
namespace {

using test::HasSameBits;
using test::IsNanPose;
using test::IsNearPose;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

PaperMapperOptions options_for_test() {
  const MappingOptions options = test::paper_options();
  return {options.returns, options.polylines, options.shape, options.paper};
}

Pose2 world_from_robot(std::size_t i) {
  const auto k = static_cast<double>(i);
  return {-0.4 + 0.15 * k, 0.1 * std::sin(k), 1.2 * kDegree * std::cos(2 * k)};
}

std::vector<Scan> walk(std::size_t count, const test::Scanner& scanner = {}) {
  std::vector<Scan> scans;
  for (std::size_t i = 0; i < count; ++i) {
    scans.push_back(test::scan_of(test::cluttered_room(2), world_from_robot(i), scanner));
    scans.back().timestamp_s = 100.0 + static_cast<double>(i);
  }
  return scans;
}

Scan blind() {
  Scan scan = walk(1).front();
  for (float& range_m : scan.sweeps[0].ranges_m) range_m = std::nanf("");
  return scan;
}

PaperMapResult mapped(const std::vector<Scan>& scans, const PaperMapperOptions& options = options_for_test(),
                      int threads = 1, PaperListener* listener = nullptr) {
  RunObserver nobody;
  PaperMapper mapper(options, {threads, nobody}, listener);
  for (const Scan& scan : scans) mapper.add_scan(scan);
  return std::move(mapper).result();
}

void expect_same_bits(const PaperMapResult& a, const PaperMapResult& b) {
  ASSERT_EQ(a.components.size(), b.components.size());
  for (std::size_t c = 0; c < a.components.size(); ++c) {
    ASSERT_EQ(a.components[c].scans.size(), b.components[c].scans.size());
    for (std::size_t i = 0; i < a.components[c].scans.size(); ++i) {
      const PlacedScan& one = a.components[c].scans[i];
      const PlacedScan& other = b.components[c].scans[i];
      EXPECT_EQ(one.scan_index, other.scan_index);
      EXPECT_THAT(one.map_from_robot, HasSameBits(other.map_from_robot));
      ASSERT_EQ(one.robot_from_sweep.size(), other.robot_from_sweep.size());
      for (std::size_t s = 0; s < one.robot_from_sweep.size(); ++s) {
        EXPECT_THAT(one.robot_from_sweep[s], HasSameBits(other.robot_from_sweep[s]));
      }
    }
  }
}

TEST(PaperMapper, WithoutScansHasAnEmptyMap) {
  const PaperMapResult result = mapped({});
  EXPECT_TRUE(result.components.empty());
  EXPECT_TRUE(result.scans.empty());
}

TEST(PaperMapper, TellsOfEachScanAtOnce) {
  RunObserver nobody;
  PaperMapper mapper(options_for_test(), {1, nobody});
  const std::vector<Scan> scans = walk(5);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const PaperScanResult& added = mapper.add_scan(scans[i]);
    EXPECT_EQ(added.scan_index, i);
    EXPECT_EQ(added.timestamp_s, 100.0 + static_cast<double>(i));
    EXPECT_EQ(added.component, 0);
    EXPECT_EQ(added.starts_component, i == 0);
    EXPECT_EQ(added.reason(), "");
    ASSERT_EQ(mapper.result().scans.size(), i + 1);
    ASSERT_EQ(mapper.result().components.at(0).scans.size(), i + 1);
    const PlacedScan& placed = mapper.result().components[0].scans[i];
    EXPECT_EQ(placed.scan_index, i);
    EXPECT_EQ(placed.timestamp_s, added.timestamp_s);
    EXPECT_THAT(placed.map_from_robot,
                IsNearPose(inverse(world_from_robot(0)) * world_from_robot(i), 0.08, 1.5 * kDegree));
    if (i == 0) {
      EXPECT_FALSE(added.alignment) << "there is nothing to align it to";
      EXPECT_FALSE(added.status());
    } else {
      EXPECT_EQ(added.status(), PaperStatus::kOk);
      const Pose2 before = mapper.result().components[0].scans[i - 1].map_from_robot;
      EXPECT_THAT(placed.map_from_robot, HasSameBits(before * added.alignment->ref_from_query));
    }
  }
  EXPECT_GT(mapper.result().shape_s, 0.0);
}

TEST(PaperMapper, AlignsToThePartialMapOfTheScansBefore) {
  const std::vector<Scan> scans = walk(4);
  PaperMapperOptions options = options_for_test();
  options.method.target.target_scans = 2;
  const PaperMapResult result = mapped(scans, options);
  const auto shape = [&](std::size_t i) {
    return shape_of(scans[i], options.returns, options.polylines, options.shape);
  };
  const Pose2 ref_from_before = inverse(result.scans[2].alignment->ref_from_query);
  const PartialMap target({moved(shape(1), ref_from_before), shape(2)}, false, options.method.histogram.radius_m);
  const PaperAlignment expected = paper_align(target, shape(3), options.method);
  ASSERT_TRUE(expected.ok());
  EXPECT_THAT(result.scans[3].alignment->ref_from_query, IsNearPose(expected.ref_from_query, 1e-9, 1e-9));
  EXPECT_EQ(result.scans[3].alignment->overlap, expected.overlap);
}

TEST(PaperMapper, AScanWithoutShapeIsInNoComponentAndTheNextStartsOne) {
  std::vector<Scan> scans = walk(4);
  scans.insert(scans.begin() + 2, blind());
  const PaperMapResult result = mapped(scans);
  ASSERT_EQ(result.scans.size(), 5U);
  EXPECT_EQ(result.scans[2].component, -1);
  EXPECT_FALSE(result.scans[2].starts_component);
  EXPECT_EQ(result.scans[2].status(), PaperStatus::kNoShape);
  EXPECT_EQ(result.scans[2].reason(), "only 0 shape points, 10 are needed");
  EXPECT_THAT(result.scans[2].alignment->ref_from_query, IsNanPose());
  EXPECT_EQ(result.scans[3].component, 1);
  EXPECT_TRUE(result.scans[3].starts_component);
  EXPECT_FALSE(result.scans[3].alignment);
  EXPECT_EQ(result.scans[4].component, 1);
  EXPECT_FALSE(result.scans[4].starts_component);
  ASSERT_EQ(result.components.size(), 2U);
  EXPECT_THAT(result.components[1].scans.at(0).map_from_robot, HasSameBits(Pose2{}));
}

TEST(PaperMapper, ARefusedScanStartsAComponentAndSaysWhy) {
  PaperMapperOptions options = options_for_test();
  options.method.trust.min_overlap_ratio = 1.0;
  const PaperMapResult result = mapped(walk(2), options);
  EXPECT_EQ(result.scans[1].status(), PaperStatus::kTooLittleOverlap);
  EXPECT_THAT(result.scans[1].reason(), HasSubstr("1 is needed"));
  EXPECT_EQ(result.scans[1].component, 1);
  EXPECT_TRUE(result.scans[1].starts_component);
  ASSERT_EQ(result.components.size(), 2U);
  ASSERT_EQ(result.components[1].scans.at(0).robot_from_sweep.size(), 1U);
}

TEST(PaperMapper, IsTheSameToTheBitForAnyNumberOfThreadsAndWithAListener) {
  test::Scanner scanner;
  scanner.num_sweeps = 4;
  scanner.num_beams = 200;
  scanner.view_rad = 100 * kDegree;
  PaperMapperOptions options = options_for_test();
  options.method.icp.decoupled = true;
  for (const LcsTarget target : {LcsTarget::kPerScan, LcsTarget::kConcatenated}) {
    options.method.lcs.target = target;
    const PaperMapResult one = mapped(walk(4, scanner), options);
    PaperListener listener;
    expect_same_bits(mapped(walk(4, scanner), options, 4), one);
    expect_same_bits(mapped(walk(4, scanner), options, 1, &listener), one);
  }
}

/// Keeps what it is shown.
struct Recorder : PaperListener {
  void on_shape(std::size_t scan_index, const std::vector<ShapePoint>& points) override {
    shapes.push_back(scan_index);
    num_points.push_back(points.size());
  }
  void on_alignment(const TracedAlignment& shown) override {
    queries.push_back(shown.query_index);
    targets.push_back(shown.targets);
    poses.push_back(shown.alignment.icp_ref_from_query);
    last_steps.push_back(shown.steps.icp.steps.back());
  }
  std::vector<std::size_t> shapes, num_points, queries;
  std::vector<std::vector<TracedTarget>> targets;
  std::vector<Pose2> poses, last_steps;
};

TEST(PaperMapper, ShowsAListenerEachShapeAndEachAlignment) {
  std::vector<Scan> scans = walk(6);
  scans.insert(scans.begin(), blind());
  Recorder recorder;
  const PaperMapResult result = mapped(scans, options_for_test(), 1, &recorder);
  EXPECT_THAT(recorder.shapes, ElementsAre(0, 1, 2, 3, 4, 5, 6));
  EXPECT_THAT(recorder.queries, ElementsAre(2, 3, 4, 5, 6)) << "the first two have nothing before them";
  const std::vector<TracedTarget>& last = recorder.targets.back();
  ASSERT_EQ(last.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(last[k].scan_index, 3 + k);
    EXPECT_EQ(last[k].num_points, recorder.num_points[3 + k]);
  }
  EXPECT_THAT(last[2].ref_from_robot, IsNearPose(Pose2{}, 1e-12, 1e-12));
  EXPECT_THAT(last[1].ref_from_robot, IsNearPose(inverse(result.scans[5].alignment->ref_from_query), 1e-12, 1e-12));
  for (std::size_t k = 0; k < 5; ++k) EXPECT_THAT(recorder.poses[k], HasSameBits(recorder.last_steps[k]));
}

/// Says once that the run shall end, when asked for the `stop_at`th time.
struct Stopper : RunObserver {
  bool keep_going() override { return ++asked != stop_at; }
  std::size_t asked = 0;
  std::size_t stop_at = 0;
};

TEST(PaperMapper, AnInterruptedScanLeavesNoMarkAndCanBePushedAgain) {
  const std::vector<Scan> scans = walk(4);
  const PaperMapResult whole = mapped(scans);
  for (const std::size_t stop_at : {1U, 3U, 6U}) {  // at the first and a later rotation, and after ICP
    Stopper stopper;
    PaperMapper mapper(options_for_test(), {1, stopper});
    mapper.add_scan(scans[0]);
    mapper.add_scan(scans[1]);
    stopper.stop_at = stopper.asked + stop_at;
    EXPECT_THROW(mapper.add_scan(scans[2]), Interrupted) << stop_at;
    EXPECT_EQ(mapper.result().scans.size(), 2U);
    EXPECT_EQ(mapper.result().components.at(0).scans.size(), 2U);
    mapper.add_scan(scans[2]);
    mapper.add_scan(scans[3]);
    expect_same_bits(mapper.result(), whole);
  }
}

TEST(PaperMapper, WhatAListenerThrowsEndsTheCall) {
  struct Full : PaperListener {
    void on_alignment(const TracedAlignment& /*alignment*/) override { throw std::runtime_error("full"); }
  };
  Full full;
  RunObserver nobody;
  PaperMapper mapper(options_for_test(), {1, nobody}, &full);
  mapper.add_scan(walk(1).front());
  EXPECT_THROW(mapper.add_scan(walk(1).front()), std::runtime_error);
  EXPECT_EQ(mapper.result().scans.size(), 1U);
}

TEST(PaperMapper, RefusesBadOptionsAndScansThatNoSensorRecorded) {
  RunObserver nobody;
  const Execution execution{1, nobody};
  PaperMapperOptions options = options_for_test();
  options.method.target.target_scans = 0;
  EXPECT_THROW(PaperMapper(options, execution), ConfigError);
  options = options_for_test();
  options.shape.spacing_m = std::nan("");
  EXPECT_THROW(PaperMapper(options, execution), ConfigError);

  PaperMapper mapper(options_for_test(), execution);
  mapper.add_scan(walk(1).front());
  Scan damaged = walk(1).front();
  damaged.sweeps[0].angle_step_rad = 1e12;
  EXPECT_THAT([&] { mapper.add_scan(damaged); }, ThrowsMessage<InputError>(HasSubstr("position 1: ")));
  EXPECT_EQ(mapper.result().scans.size(), 1U);
}

TEST(PaperMapper, WorksWithThePapersLiteralReadingsToo) {
  PaperMapperOptions options = options_for_test();
  read_literally(options.method);
  EXPECT_EQ(options.method.lcs.target, LcsTarget::kConcatenated);
  options.shape.points = ShapePoints::kBeams;
  const PaperMapResult result = mapped(walk(4), options);
  ASSERT_EQ(result.components.size(), 1U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_THAT(result.components[0].scans.at(i).map_from_robot,
                IsNearPose(inverse(world_from_robot(0)) * world_from_robot(i), 0.15, 2 * kDegree));
  }
}

}  // namespace
}  // namespace shapemap
