// SPDX-License-Identifier: GPL-3.0-or-later
// A robot goes round a ring several times, and redundant keyframes are culled.
#include "mapper/keyframe_culling.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "localization/localization_numbers.hpp"
#include "shapemap/mapper/map_log.hpp"
#include "support/matchers.hpp"
#include "support/ring_laps.hpp"

namespace shapemap {
namespace {

using test::KnownGraph;
using test::Laps;
using test::two_laps;

MappingOptions quick() { return test::quick_mapping(); }

MapResult mapped(const Log& log, const MappingOptions& options) {
  MappingEvents nobody;
  return map_log(log, options, nobody);
}

std::size_t num_keyframes(const MapResult& result) {
  return static_cast<std::size_t>(
      std::count_if(result.scans.begin(), result.scans.end(), [](const ScanResult& p) { return p.is_keyframe; }));
}

std::vector<Pose2> poses_of(const MapResult& result) {
  std::vector<Pose2> poses;
  for (const PlacedScan& placed : result.placed()) poses.push_back(placed.map_from_robot);
  return poses;
}

TEST(RedundantKeyframes, AreEarlierKeyframesAtTheSamePlace) {
  const Laps& laps = two_laps();
  const KnownGraph known(laps);
  const auto redundant = find_redundant_keyframes(known.graph, known.map, quick().robust, 1).of_keyframe;
  ASSERT_EQ(redundant.size(), laps.truth.size());
  std::size_t found = 0;
  for (std::size_t b = 0; b < redundant.size(); ++b) {
    if (!redundant[b]) continue;
    ++found;
    const std::size_t a = redundant[b]->keyframe;
    EXPECT_LT(a, b);
    EXPECT_FALSE(redundant[a]) << "one that goes itself stands for another";
    const Pose2 a_from_b = inverse(laps.truth[a]) * laps.truth[b];
    EXPECT_LT(a_from_b.translation().norm(), 0.5);
    EXPECT_THAT(redundant[b]->pose.ref_from_query, test::IsNearPose(a_from_b, 0.06, 1.5 * kDegree));
    EXPECT_LT(b + kLocalization.redundancy.keyframes_in_use, redundant.size());
  }
  EXPECT_GT(found, test::kRingLap / 4);  // the robot sways by more than 20 degrees
}

TEST(RedundantKeyframes, TellARightMapFromOneThatIsFolded) {
  const Laps& laps = two_laps();
  const KnownGraph right(laps);
  const RedundantKeyframes of_right = find_redundant_keyframes(right.graph, right.map, quick().robust, 1);
  EXPECT_GT(of_right.num_again, test::kRingLap / 4);
  EXPECT_TRUE(of_right.are_of_right_map());
  KnownGraph folded(laps);
  for (std::size_t b = test::kRingLap; b < laps.truth.size(); ++b) {  // shifts the second lap along the ring
    folded.map.map_from_keyframe[b] = laps.truth[b - 5];
  }
  const RedundantKeyframes of_folded = find_redundant_keyframes(folded.graph, folded.map, quick().robust, 1);
  EXPECT_GT(of_folded.num_again, test::kRingLap / 4);
  EXPECT_FALSE(of_folded.are_of_right_map());
  EXPECT_THAT(of_right.is_in_doubt, testing::Each(false));
  EXPECT_THAT(of_folded.is_in_doubt, testing::Contains(true));
  for (std::size_t b = 0; b < laps.truth.size(); ++b) {
    EXPECT_FALSE(of_folded.is_in_doubt[b] && of_folded.of_keyframe[b]) << b;
  }
  EXPECT_TRUE(RedundantKeyframes().are_of_right_map());
}

TEST(RedundantKeyframes, AreNotForKeyframesInDoubt) {
  const Laps& laps = two_laps();
  KnownGraph known(laps);
  const auto all = find_redundant_keyframes(known.graph, known.map, quick().robust, 1).of_keyframe;
  const auto first =
      std::find_if(all.begin(), all.end(), [](const auto& replacement) { return replacement.has_value(); });
  ASSERT_NE(first, all.end());
  const auto b = static_cast<std::size_t>(first - all.begin());
  known.map.loop_constrained[b] = false;
  known.graph.edges[b].choice.margin = 0.01;  // makes the edge doubtful
  ASSERT_LT(edge_probability(known.graph.edges[b]), 0.6);
  EXPECT_FALSE(find_redundant_keyframes(known.graph, known.map, quick().robust, 1).of_keyframe[b]);
  known.map.loop_constrained[b] = true;
  EXPECT_TRUE(find_redundant_keyframes(known.graph, known.map, quick().robust, 1).of_keyframe[b]);
  known.map.edge_choice[b] = -1;
  EXPECT_FALSE(find_redundant_keyframes(known.graph, known.map, quick().robust, 1).of_keyframe[b]);
}

TEST(KeyframeCulling, LeavesAGraphThatAgreesWithTheMap) {
  const Laps& laps = two_laps();
  KnownGraph known(laps);
  const auto redundant = find_redundant_keyframes(known.graph, known.map, quick().robust, 1).of_keyframe;
  MatchCandidate here;
  here.ref_from_query = {0.1, 0.2, 0.3};
  const std::size_t culled = static_cast<std::size_t>(
      std::find_if(redundant.begin(), redundant.end(), [](const auto& s) { return s.has_value(); }) -
      redundant.begin());
  known.graph.attached.push_back({1000, culled, here});
  LoopCandidates loops;
  loops.num_searched = laps.truth.size() - kLocalization.redundancy.keyframes_in_use;
  cull_keyframes(redundant, quick(), known.map, known.graph, loops);

  const auto num_culled = static_cast<std::size_t>(
      std::count_if(redundant.begin(), redundant.end(), [](const auto& s) { return s.has_value(); }));
  ASSERT_EQ(known.graph.keyframes.size(), laps.truth.size() - num_culled);
  ASSERT_EQ(known.graph.edges.size(), known.graph.keyframes.size() - 1);
  EXPECT_EQ(known.graph.attached.size(), num_culled + 1);
  EXPECT_EQ(loops.num_searched, known.graph.keyframes.size() - kLocalization.redundancy.keyframes_in_use);

  std::set<std::size_t> all;
  for (const Keyframe& keyframe : known.graph.keyframes) all.insert(keyframe.scan_index);
  std::size_t num_renewed = 0;
  for (std::size_t i = 0; i < known.graph.edges.size(); ++i) {
    const Pose2& a = laps.truth[known.graph.keyframes[i].scan_index];
    const Pose2& b = laps.truth[known.graph.keyframes[i + 1].scan_index];
    const PoseConstraint edge = edge_constraint(known.graph, i, 0);
    EXPECT_THAT(edge.a_from_b, test::IsNearPose(inverse(a) * b, 1e-9, 1e-9));
    if (!known.graph.edges[i].culled_covariance) continue;
    ++num_renewed;
    EXPECT_EQ(edge_probability(known.graph.edges[i]), 1.0);
    EXPECT_TRUE(edge.covariance.allFinite());
  }
  EXPECT_GT(num_renewed, 0U);
  for (const AttachedScan& scan : known.graph.attached) {
    const Pose2 keyframe = laps.truth[known.graph.keyframes[scan.keyframe].scan_index];
    const bool is_mine = scan.scan_index == 1000;
    const Pose2 truth = is_mine ? laps.truth[culled] * here.ref_from_query : laps.truth[scan.scan_index];
    EXPECT_THAT(keyframe * scan.pose.ref_from_query, test::IsNearPose(truth, 0.10, 2 * kDegree));
    EXPECT_TRUE(is_mine || all.insert(scan.scan_index).second);
  }
  EXPECT_EQ(all.size(), laps.truth.size());
  for (const EdgeCandidate& loop : loops.candidates) {
    const Pose2& a = laps.truth[known.graph.keyframes[loop.a].scan_index];
    const Pose2& b = laps.truth[known.graph.keyframes[loop.b].scan_index];
    EXPECT_THAT(loop.a_from_b, test::IsNearPose(inverse(a) * b, 1e-9, 1e-9));
  }
}

TEST(KeyframeCulling, OfNoneChangesNothing) {
  const Laps& laps = two_laps();
  KnownGraph known(laps);
  LoopCandidates loops;
  loops.candidates.push_back({3, 60, {1, 2, 3}, Eigen::Matrix3d::Identity(), 1.5});
  loops.num_searched = 70;
  loops.num_bridged = 69;
  known.map.constraints.clear();
  const std::vector<std::optional<ReplacementKeyframe>> none(laps.truth.size());
  cull_keyframes(none, quick(), known.map, known.graph, loops);
  EXPECT_EQ(known.graph.keyframes.size(), laps.truth.size());
  ASSERT_EQ(loops.candidates.size(), 1U);
  EXPECT_EQ(loops.candidates[0].a, 3U);
  EXPECT_EQ(loops.candidates[0].b, 60U);
  EXPECT_EQ(loops.num_searched, 70U);
  EXPECT_EQ(loops.num_bridged, 69U);
}

/// After four laps, the map is as right as without culling, and has fewer keyframes.
TEST(KeyframeCulling, NeedsNoMoreKeyframesForMoreLaps) {
  const Laps laps(4 * test::kRingLap);
  const MapResult all = mapped(laps.log, quick());
  EXPECT_EQ(num_keyframes(all), laps.truth.size());
  MappingOptions options = quick();
  options.robust.keyframes.settle_at = 70;
  const MapResult result = mapped(laps.log, options);
  ASSERT_EQ(result.components.size(), 1U);
  ASSERT_EQ(result.placed().size(), laps.truth.size());
  EXPECT_LT(test::worst_off_m(poses_of(result), laps.truth), 0.10);
  EXPECT_LT(num_keyframes(result), laps.truth.size() * 3 / 4);
  EXPECT_TRUE(result.scans[20].loop_constrained);
  for (std::size_t i = 0; i < result.scans.size(); ++i) EXPECT_EQ(result.placed()[i].scan_index, i);

  options.run.threads = 3;
  const MapResult threaded = mapped(laps.log, options);
  for (std::size_t i = 0; i < laps.truth.size(); ++i) {
    EXPECT_THAT(threaded.placed()[i].map_from_robot, test::HasSameBits(result.placed()[i].map_from_robot));
  }
}

}  // namespace
}  // namespace shapemap
