// SPDX-License-Identifier: GPL-3.0-or-later
// Milliseconds of the stages of the robust scan matcher: on scans of a furnished room with 181 and 361 beams, and on
// two scans of the demo log (four sweeps, 1604 beams).
#include <benchmark/benchmark.h>

#include "shapemap/io/log_file.hpp"
#include "shapemap/matching/lcs_hypotheses.hpp"
#include "shapemap/matching/rotation_hypotheses.hpp"
#include "shapemap/matching/scan_matcher.hpp"
#include "support/views.hpp"

namespace shapemap {
namespace {

constexpr int kDemo = 0;  // stands for the demo log in place of a number of beams
constexpr double kCoarseSlack = 2.0;
constexpr std::size_t kCoarseStride = 2;

/// Two scans and their relative pose.
struct Pair {
  Scan reference;
  Scan query;
  Pose2 ref_from_query;
};

Pair demo_pair() {
  const Log log = read_log(SHAPEMAP_DEMO_LOG);
  const Scan& reference = log.scans.at(3);
  const Scan& query = log.scans.at(4);
  return {reference, query, inverse(reference.reference_pose.value()) * query.reference_pose.value()};
}

Pair room_pair(int num_beams) {
  std::mt19937 rng(1);
  const test::World world = test::cluttered_room(2);
  test::Scanner scanner;
  scanner.num_beams = num_beams;
  scanner.view_rad = num_beams * (num_beams > 181 ? 0.5 : 1.0) * kDegree;
  scanner.noise_m = 0.01;
  const Pose2 ref_from_query{0.5, -0.3, 0.4};
  Scan reference = test::scan_of(world, {}, scanner, rng);
  return {std::move(reference), test::scan_of(world, ref_from_query, scanner, rng), ref_from_query};
}

const Pair& pair_of(const benchmark::State& state) {
  static const Pair demo = demo_pair();
  static const Pair coarse = room_pair(181);
  static const Pair fine = room_pair(361);
  return state.range(0) == kDemo ? demo : state.range(0) == 181 ? coarse : fine;
}

struct Views {
  explicit Views(const Pair& pair) : reference(test::view_of(pair.reference)), query(test::view_of(pair.query)) {}
  ScanView reference;
  ScanView query;
};

void all_scans(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgName("beams")->Arg(181)->Arg(361)->Arg(kDemo)->Unit(benchmark::kMillisecond);
}

void BM_ViewOf(benchmark::State& state) {
  const Pair& pair = pair_of(state);
  for (auto _ : state) benchmark::DoNotOptimize(test::view_of(pair.query));
  state.counters["points"] = static_cast<double>(test::view_of(pair.query).size());
}
BENCHMARK(BM_ViewOf)->Apply(all_scans);

void BM_RotationHypotheses(benchmark::State& state) {
  const Views views(pair_of(state));
  const CandidateOptions options;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        rotation_hypotheses(views.reference.tangents, views.query.tangents, options.rotation_peaks));
  }
}
BENCHMARK(BM_RotationHypotheses)->Apply(all_scans);

void BM_VotingOfOneRotation(benchmark::State& state) {
  const Views views(pair_of(state));
  const VotingOptions options;
  const TranslationVoting voting(views.reference, max_shift_m(views.reference, views.query, options), options);
  for (auto _ : state) benchmark::DoNotOptimize(voting.peaks(views.query, 0.4, options.peaks));
}
BENCHMARK(BM_VotingOfOneRotation)->Apply(all_scans);

void BM_LcsOfOneRotation(benchmark::State& state) {
  const Views views(pair_of(state));
  const LcsHypotheses shapes(views.reference, views.query);
  for (auto _ : state) benchmark::DoNotOptimize(shapes.translations(0.4, CandidateOptions().shape_segments));
}
BENCHMARK(BM_LcsOfOneRotation)->Apply(all_scans);

void BM_CoarseVisibility(benchmark::State& state) {
  const Pair& pair = pair_of(state);
  const Views views(pair);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        visibility(views.reference, views.query, pair.ref_from_query, {}, {kCoarseSlack, kCoarseStride}));
  }
}
BENCHMARK(BM_CoarseVisibility)->Apply(all_scans);

void BM_Refinement(benchmark::State& state) {
  const Pair& pair = pair_of(state);
  const Views views(pair);
  const Pose2 start = pair.ref_from_query * Pose2{0.1, 0.1, 2 * kDegree};
  for (auto _ : state) benchmark::DoNotOptimize(refined_candidate(views.reference, views.query, start, {}));
}
BENCHMARK(BM_Refinement)->Apply(all_scans);

void BM_MatchScans(benchmark::State& state) {
  const Views views(pair_of(state));
  for (auto _ : state) benchmark::DoNotOptimize(match_scans(views.reference, views.query, {}));
}
BENCHMARK(BM_MatchScans)->Apply(all_scans);

/// A match with the search over all rotations, which follows when tangents alone do not determine the rotation.
void BM_MatchScansOfDifferentPlaces(benchmark::State& state) {
  const Views views(pair_of(state));
  const ScanView elsewhere = test::view_from(test::strange_place(1), {});
  for (auto _ : state) benchmark::DoNotOptimize(match_scans(views.reference, elsewhere, {}));
}
BENCHMARK(BM_MatchScansOfDifferentPlaces)->Apply(all_scans);

}  // namespace
}  // namespace shapemap
