// SPDX-License-Identifier: GPL-3.0-or-later
// Speed of place descriptors, of the optimisation of a pose graph, and of the score of a map.
#include <benchmark/benchmark.h>

#include <random>

#include "shapemap/inference/map_score.hpp"
#include "shapemap/loops/place_descriptor.hpp"
#include "support/ring_walk.hpp"

namespace shapemap {
namespace {

void BM_PlaceDescriptor(benchmark::State& state) {
  const ScanView view = test::view_from(test::ring_world(1), test::on_ring(3.0));
  for (auto _ : state) benchmark::DoNotOptimize(place_descriptor(view));
  state.counters["points"] = static_cast<double>(view.size());
}
BENCHMARK(BM_PlaceDescriptor)->Unit(benchmark::kMicrosecond);

PlaceDescriptor random_descriptor(std::mt19937& rng) {
  std::uniform_real_distribution<float> unit(0.0F, 0.06F);
  PlaceDescriptor descriptor;
  for (float& value : descriptor) value = unit(rng);
  return descriptor;
}

/// The search for similar places of a new scan among so many.
void BM_MostAlike(benchmark::State& state) {
  std::mt19937 rng(1);
  PlaceIndex index;
  const auto count = static_cast<std::size_t>(state.range(0));
  while (index.size() < count) index.add(random_descriptor(rng));
  constexpr std::size_t kWanted = 10;
  for (auto _ : state) benchmark::DoNotOptimize(index.most_alike(count - 1, count - kWanted, kWanted));
}
BENCHMARK(BM_MostAlike)->ArgName("nodes")->Arg(1000)->Arg(20000)->Unit(benchmark::kMicrosecond);

void BM_SolvePoseGraph(benchmark::State& state) {
  std::mt19937 rng(1);
  const auto count = static_cast<std::size_t>(state.range(0));
  const std::vector<Pose2> truth = test::random_walk(rng, count);
  const std::vector<PoseConstraint> constraints = test::odometry_and_loops(truth, count / 5, 0.02, rng);
  std::vector<Pose2> start = truth;
  for (std::size_t n = 1; n < count; ++n) start[n] = start[n] * test::random_pose(rng, 0.1, 0.03);
  for (auto _ : state) benchmark::DoNotOptimize(solve_pose_graph(start, constraints));
}
BENCHMARK(BM_SolvePoseGraph)->ArgName("nodes")->Arg(100)->Arg(1000)->Unit(benchmark::kMillisecond);

struct Ring {
  std::vector<Pose2> truth = test::ring_walk(test::kRingLap + 8, 2);
  test::Views views = test::views_along(test::ring_world(1), truth);
};

void BM_MapScore(benchmark::State& state) {
  const Ring ring;
  for (auto _ : state) benchmark::DoNotOptimize(MapScore(ring.views, {}, 1).of(ring.truth));
  state.counters["nodes"] = static_cast<double>(ring.truth.size());
}
BENCHMARK(BM_MapScore)->Unit(benchmark::kMillisecond);

/// The score of the same map again, which needs no comparison of scans.
void BM_MapScoreThatIsKnown(benchmark::State& state) {
  const Ring ring;
  MapScore score(ring.views, {}, 1);
  score.of(ring.truth);
  for (auto _ : state) benchmark::DoNotOptimize(score.of(ring.truth));
}
BENCHMARK(BM_MapScoreThatIsKnown)->Unit(benchmark::kMillisecond);

void BM_NearPairs(benchmark::State& state) {
  std::mt19937 rng(1);
  std::vector<Pose2> poses;
  for (std::int64_t n = 0; n < state.range(0); ++n) poses.push_back(test::random_pose(rng, 40.0, kPi));
  for (auto _ : state) benchmark::DoNotOptimize(near_pairs(poses, 6.0));
}
BENCHMARK(BM_NearPairs)->ArgName("nodes")->Arg(1000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace shapemap
