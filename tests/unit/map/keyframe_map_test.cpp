// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/keyframe_map.hpp"

#include <gmock/gmock.h>

#include "shapemap/graph/loop_closing.hpp"
#include "support/ring_walk.hpp"
#include "support/views.hpp"

namespace shapemap {
namespace {

using ::testing::Each;

/// A chain of three that look all round, or only to one side, each of whose links is most likely wrong.
struct ImprobableChain {
  explicit ImprobableChain(const test::Scanner& scanner) {
    const test::World world = test::ring_world(1);
    for (const Pose2& pose : test::ring_walk(3, 2, 4.0)) {
      const auto view = std::make_shared<ScanView>(test::view_from(world, pose, scanner, 1));
      chain.keyframes.push_back({chain.keyframes.size(), view, {}});
    }
    chain.links.resize(2);
    for (KeyframeLink& link : chain.links) {
      link.hypotheses = {hypothesis_at(*chain.keyframes[0].view, *chain.keyframes[1].view, {3.0, 1.0, 1.0}, {})};
      link.choice = {0, 0.0, {0.0}};
    }
  }

  std::vector<int> choices() const { return map_of_chain(chain, options).link_choice; }

  KeyframeChain chain;
  MappingOptions options;
};

TEST(KeyframeMap, ImprobableLinksAreCutAtOnce) {
  const ImprobableChain walk(test::half_circle());
  ASSERT_LT(link_probability(walk.chain.links[0]), walk.options.smoothing.split_below);
  EXPECT_FALSE(is_judged_by_all_scans(walk.chain, 0, walk.options));
  EXPECT_THAT(walk.choices(), Each(kCut));
}

TEST(KeyframeMap, UnlessAllScansJudgeThemLater) {
  ImprobableChain walk(test::full_circle());
  EXPECT_TRUE(is_judged_by_all_scans(walk.chain, 0, walk.options));
  EXPECT_THAT(walk.choices(), Each(0));
  walk.options.link_revision.doubt_below = 0.0;
  EXPECT_THAT(walk.choices(), Each(kCut)) << "nobody judges them";
  walk.options = {};
  walk.options.loops.close_loops = false;
  EXPECT_THAT(walk.choices(), Each(kCut)) << "the bare chain has no other judge";
}

}  // namespace
}  // namespace shapemap
