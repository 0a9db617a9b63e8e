// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/mapper/mapping_events.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <stdexcept>
#include <thread>

#include "shapemap/mapper/map_log.hpp"
#include "shapemap/mapper/mapper.hpp"
#include "shapemap/matching/match_probability.hpp"
#include "support/matchers.hpp"
#include "support/ring_laps.hpp"
#include "support/synthetic_world.hpp"

namespace shapemap {
namespace {

using test::HasSameBits;
using ::testing::ElementsAre;

constexpr std::size_t kCount = 6;
constexpr std::size_t kBlind = 3;  ///< index of the scan without returns

Log walk_with_a_blind_scan() {
  Log log;
  for (std::size_t i = 0; i < kCount; ++i) {
    const auto k = static_cast<double>(i);
    log.scans.push_back(test::scan_of(test::cluttered_room(2), {-0.4 + 0.15 * k, 0.02 * k * k, 0.0}));
    log.scans.back().timestamp_s = k;
  }
  for (float& range_m : log.scans[kBlind].sweeps[0].ranges_m) range_m = 0.0F;
  return log;
}

MappingOptions options_of(Method method) {
  MappingOptions options = test::paper_options();
  options.run.method = method;
  options.robust.keyframes.step_m = 0.0;  // each scan is matched to the one before it
  return options;
}

/// Keeps copies of the events.
struct Recorder : MappingEvents {
  struct Edge {
    std::size_t reference, query, num_own;
    double insufficient_view;
    std::vector<MatchCandidate> candidates;
  };
  void on_shape(std::size_t index, const std::vector<ShapePoint>& points) override {
    indices.push_back(index);
    num_points.push_back(points.size());
  }
  void on_alignment(const TracedAlignment& shown) override {
    alignments.push_back(shown.alignment);
    steps.push_back(shown.steps);
    targets.push_back(shown.targets);
    queries.push_back(shown.query_index);
  }
  void on_edge(const EdgeFound& l) override {
    edges.push_back({l.reference_index, l.query_index, l.num_own, l.insufficient_view, l.candidates});
  }
  void on_edge_chosen(const EdgeChosen& choice) override { choices.push_back(choice); }

  std::vector<std::size_t> indices, num_points, queries;
  std::vector<PaperAlignment> alignments;
  std::vector<PaperTrace> steps;
  std::vector<std::vector<TracedTarget>> targets;
  std::vector<Edge> edges;
  std::vector<EdgeChosen> choices;
};

MapResult mapped(const Log& log, Method method, MappingEvents* sink) {
  MappingEvents nobody;
  return map_log(log, options_of(method), sink ? *sink : nobody);
}

TEST(MappingEvents, LookingOnChangesNoBit) {
  const Log log = walk_with_a_blind_scan();
  for (const Method method : {Method::kPaper, Method::kRobust}) {
    Recorder recorder;
    const MapResult with = mapped(log, method, &recorder);
    const MapResult without = mapped(log, method, nullptr);
    ASSERT_EQ(with.scans.size(), kCount);
    ASSERT_EQ(with.components.size(), without.components.size());
    for (std::size_t f = 0; f < with.components.size(); ++f) {
      ASSERT_EQ(with.components[f].scans.size(), without.components[f].scans.size());
      for (std::size_t i = 0; i < with.components[f].scans.size(); ++i) {
        EXPECT_THAT(with.components[f].scans[i].map_from_robot,
                    HasSameBits(without.components[f].scans[i].map_from_robot));
      }
    }
    EXPECT_THAT(recorder.indices, ElementsAre(0, 1, 2, 3, 4, 5));
    EXPECT_EQ(recorder.num_points[kBlind], 0U);
  }
}

TEST(MappingEvents, SeesEachAlignmentOfThePapersMethodWithItsTargets) {
  Recorder recorder;
  const MapResult result = mapped(walk_with_a_blind_scan(), Method::kPaper, &recorder);
  EXPECT_TRUE(recorder.edges.empty());
  EXPECT_THAT(recorder.queries, ElementsAre(1, 2, 5));  // scan 4 has nothing before it
  for (std::size_t k = 0; k < recorder.queries.size(); ++k) {
    const PaperAlignment& alignment = recorder.alignments[k];
    const PaperTrace& steps = recorder.steps[k];
    EXPECT_THAT(alignment.ref_from_query, HasSameBits(result.scans[recorder.queries[k]].paper->ref_from_query));
    ASSERT_GE(steps.best_rotation, 0);
    const RotationMatch& best = steps.rotations[static_cast<std::size_t>(steps.best_rotation)];
    EXPECT_THAT(best.target_from_query(), HasSameBits(alignment.shape_ref_from_query));
    EXPECT_GE(best.lcs.size(), best.spread.size());
    EXPECT_EQ(best.translation.kept.size(), static_cast<std::size_t>(alignment.num_correspondences));
    EXPECT_THAT(steps.icp.steps.back(), HasSameBits(alignment.icp_ref_from_query));
  }
  ASSERT_EQ(recorder.targets[1].size(), 2U);
  EXPECT_EQ(recorder.targets[1][0].scan_index, 0U);
  EXPECT_EQ(recorder.targets[1][1].scan_index, 1U);
  EXPECT_THAT(recorder.targets[1][1].ref_from_robot, test::IsNearPose(Pose2{}, 1e-12, 1e-12));
  EXPECT_EQ(recorder.targets[1][1].num_points, recorder.num_points[1]);
}

TEST(MappingEvents, SeesWhatTheRobustMethodChoosesFrom) {
  Recorder recorder;
  const MapResult result = mapped(walk_with_a_blind_scan(), Method::kRobust, &recorder);
  EXPECT_TRUE(recorder.alignments.empty());
  ASSERT_EQ(recorder.edges.size(), 4U);
  ASSERT_EQ(recorder.choices.size(), 4U);
  EXPECT_EQ(recorder.edges[2].reference, 2U);  // the edge passes over the blind scan
  EXPECT_EQ(recorder.edges[2].query, 4U);
  for (std::size_t k = 0; k < recorder.edges.size(); ++k) {
    const Recorder::Edge& edge = recorder.edges[k];
    const EdgeChosen& choice = recorder.choices[k];
    EXPECT_EQ(choice.reference_index, edge.reference);
    EXPECT_EQ(choice.query_index, edge.query);
    EXPECT_GT(edge.num_own, 0U);
    EXPECT_LE(edge.num_own, edge.candidates.size());
    ASSERT_LT(choice.candidate, edge.candidates.size());
    EXPECT_THAT(edge.candidates[choice.candidate].ref_from_query,
                HasSameBits(result.scans[edge.query].match.ranked[0].ref_from_query));
  }
}

TEST(MappingEvents, SeesHowLittleNarrowScansSeeAndThatCountsInTheResult) {
  test::Scanner narrow;
  narrow.num_beams = 91;
  narrow.view_rad = 91 * kDegree;
  Log log;
  for (const double x_m : {0.0, 0.15}) {
    log.scans.push_back(test::scan_of(test::cluttered_room(2), {x_m, 0.0, 0.0}, narrow));
  }
  MappingOptions options = options_of(Method::kRobust);
  options.robust.edge_verification.doubt_below = 0.0;  // edges are judged by their two scans
  Recorder recorder;
  const MapResult result = map_log(log, options, recorder);
  ASSERT_EQ(recorder.edges.size(), 1U);
  const Recorder::Edge& edge = recorder.edges[0];
  EXPECT_NEAR(edge.insufficient_view, 0.2, 0.05);
  const EdgeChosen& choice = recorder.choices.at(0);
  const double match = match_probability(edge.candidates.at(choice.candidate), choice.margin);
  EXPECT_EQ(result.scans[1].match.probability, odometry_probability(match, edge.insufficient_view));
}

TEST(MappingEvents, WhatItThrowsEndsTheRun) {
  struct Full : MappingEvents {
    void on_shape(std::size_t index, const std::vector<ShapePoint>& /*points*/) override {
      if (index == 2) throw std::runtime_error("full");
    }
  };
  const Log log = walk_with_a_blind_scan();
  for (const Method method : {Method::kPaper, Method::kRobust}) {
    Full sink;
    EXPECT_THROW(mapped(log, method, &sink), std::runtime_error);
  }
}

/// Counts the events of the back end, and checks that calls never overlap.
struct Counter : MappingEvents {
  void on_stage(std::string_view) override {
    entered([&] { caller = std::this_thread::get_id(); });
  }
  void on_shape(std::size_t, const std::vector<ShapePoint>&) override {
    entered([&] { ++num_shapes; });
  }
  void on_scan(const ScanUpdate& scan) override {
    entered([&] { scans.push_back(scan.scan); });
  }
  void on_edge(const EdgeFound& edge) override {
    entered([&] { num_candidates += edge.candidates.size(); });
  }
  void on_loop(const LoopJudged& loop) override {
    entered([&] {
      ++(loop.is_accepted ? num_accepted : num_refused);
      EXPECT_EQ(loop.is_accepted, loop.why_not.empty());
      EXPECT_LT(loop.loop.a, loop.loop.b);
    });
  }
  void on_culled(const KeyframesCulled& gone) override {
    entered([&] { culled.insert(culled.end(), gone.scans.begin(), gone.scans.end()); });
  }
  void on_map(const Map& map) override {
    entered([&] { versions.push_back(map.version); });
  }
  void on_edge_chosen(const EdgeChosen&) override {
    entered([&] { ++num_chosen; });
  }

  template <class What>
  void entered(const What& what) {
    EXPECT_FALSE(is_in_call.exchange(true)) << "two calls at a time";
    what();
    is_in_call = false;
  }

  std::atomic<bool> is_in_call{false};
  std::thread::id caller;
  std::size_t num_shapes = 0, num_candidates = 0, num_accepted = 0, num_refused = 0, num_chosen = 0;
  std::vector<std::size_t> scans, culled;
  std::vector<MapVersion> versions;
};

TEST(MappingEvents, TellOfScansLoopsMapsAndCulledKeyframes) {
  const test::Laps laps(3 * test::kRingLap);
  MappingOptions options = test::quick_mapping();
  options.robust.keyframes.settle_at = 64;
  const std::size_t count = laps.log.scans.size();
  for (const bool background : {false, true}) {
    Counter counter;
    Mapper mapper(options, {true, background}, &counter);
    for (const Scan& scan : laps.log.scans) mapper.add_scan(scan);
    const MapResult result = mapper.finish();
    EXPECT_EQ(counter.num_shapes, count);
    ASSERT_EQ(counter.scans.size(), count);
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(counter.scans[i], i);
    EXPECT_GT(counter.num_candidates, count);
    EXPECT_GT(counter.num_accepted, 0U);
    EXPECT_GT(counter.num_chosen, count / 2);
    ASSERT_EQ(counter.versions.size(), mapper.map()->version);
    for (std::size_t k = 0; k < counter.versions.size(); ++k) EXPECT_EQ(counter.versions[k], k + 1);
    EXPECT_FALSE(counter.culled.empty());
    for (const std::size_t scan : counter.culled) EXPECT_FALSE(result.scans[scan].is_keyframe) << scan;
    EXPECT_EQ(counter.caller, std::this_thread::get_id());
  }
}

TEST(MappingEvents, GoToAllListenersWhileAllWantToGoOn) {
  struct Listener : MappingEvents {
    void on_stage(std::string_view) override { ++num_stages; }
    void on_scan(const ScanUpdate&) override { ++num_scans; }
    bool keep_going() override { return num_scans < most; }
    std::size_t num_stages = 0, num_scans = 0, most = 1000;
  };
  Listener one;
  Listener other;
  EventFanOut both({&one, &other});
  const Log log = walk_with_a_blind_scan();
  EXPECT_FALSE(map_log(log, options_of(Method::kRobust), both).interrupted);
  EXPECT_EQ(one.num_scans, log.scans.size());
  EXPECT_EQ(other.num_scans, log.scans.size());
  EXPECT_GT(one.num_stages, 0U);
  other.most = 0;
  EXPECT_TRUE(map_log(log, options_of(Method::kRobust), both).interrupted);
}

}  // namespace
}  // namespace shapemap
