// SPDX-License-Identifier: GPL-3.0-or-later
// Speed of the stages of the paper on real sizes: scans of the demo log have one point per reading (1604) as in the
// paper, so that the sizes do not depend on the scene. Stated targets, one core: similarity of 1600 x 4800 points 10
// ms, LCS of that size 1 ms, alignment of 1604 points to three scans over five rotations 60 ms, with ICP 100 ms.
#include <benchmark/benchmark.h>

#include "shapemap/io/log_file.hpp"
#include "shapemap/mapper/mapper_options.hpp"
#include "shapemap/paper/lcs.hpp"
#include "shapemap/paper/paper_align.hpp"

namespace shapemap {
namespace {

constexpr std::size_t kQuery = 4;  // scan of the demo log; the three before it are the target
constexpr std::size_t kNumPoints = 1604;

const Log& demo_log() {
  static const Log log = read_log(SHAPEMAP_DEMO_LOG);
  return log;
}

/// Returns the shape of a scan with exactly kNumPoints points; the last points are repeated in place of readings
/// without return.
Shape full_shape(std::size_t scan) {
  MappingOptions options;
  options.shape.points = ShapePoints::kBeams;
  Shape shape = shape_of(demo_log().scans.at(scan), options.returns, options.polylines, options.shape);
  for (std::size_t i = 0; shape.size() < kNumPoints; ++i)
    shape.points.push_back(shape.points[shape.size() - 1 - 2 * i]);
  return shape;
}

/// Returns the three scans before the query, at their reference poses, in the frame of the latest.
std::vector<Shape> target_scans() {
  std::vector<Shape> scans;
  const Pose2 ref_from_map = inverse(demo_log().scans[kQuery - 1].reference_pose.value());
  for (std::size_t k = kQuery - 3; k < kQuery; ++k) {
    scans.push_back(moved(full_shape(k), ref_from_map * demo_log().scans[k].reference_pose.value()));
  }
  return scans;
}

Shape joined(const std::vector<Shape>& scans) {
  Shape all;
  for (const Shape& scan : scans) all.points.insert(all.points.end(), scan.points.begin(), scan.points.end());
  return all;
}

ScanFeatures features(const Shape& shape) {
  const HistogramOptions options;
  return features_of(shape, NeighbourDirections(shape, options.radius_m), 0.0, options.norm);
}

void set_sizes(benchmark::State& state, std::size_t rows, std::size_t columns) {
  state.counters["query_points"] = static_cast<double>(rows);
  state.counters["target_points"] = static_cast<double>(columns);
}

void BM_ShapeOfScan(benchmark::State& state) {
  const MappingOptions options;
  for (auto _ : state) {
    benchmark::DoNotOptimize(shape_of(demo_log().scans[kQuery], options.returns, options.polylines, options.shape));
  }
}
BENCHMARK(BM_ShapeOfScan)->Unit(benchmark::kMillisecond);

void BM_Similarity(benchmark::State& state) {
  const ScanFeatures query = features(full_shape(kQuery));
  const SimilarityIndex index(features(joined(target_scans())), {});
  for (auto _ : state) benchmark::DoNotOptimize(index.matches(query));
  set_sizes(state, query.size(), 3 * kNumPoints);
}
BENCHMARK(BM_Similarity)->Unit(benchmark::kMillisecond);

void BM_LcsWithTraceback(benchmark::State& state) {
  const SimilarityIndex index(features(joined(target_scans())), {});
  const BitMatrix matches = index.matches(features(full_shape(kQuery)));
  for (auto _ : state) benchmark::DoNotOptimize(longest_common_subsequence(matches));
  set_sizes(state, matches.rows(), matches.columns());
}
BENCHMARK(BM_LcsWithTraceback)->Unit(benchmark::kMillisecond);

/// The textbook's table with traceback, for comparison.
void BM_LcsByDynamicProgramming(benchmark::State& state) {
  const SimilarityIndex index(features(joined(target_scans())), {});
  const BitMatrix matches = index.matches(features(full_shape(kQuery)));
  const std::size_t width = matches.columns() + 1;
  for (auto _ : state) {
    std::vector<std::uint16_t> length((matches.rows() + 1) * width, 0);
    for (std::size_t i = 1; i <= matches.rows(); ++i) {
      for (std::size_t j = 1; j < width; ++j) {
        length[i * width + j] = matches.test(i - 1, j - 1)
                                    ? static_cast<std::uint16_t>(length[(i - 1) * width + j - 1] + 1)
                                    : std::max(length[(i - 1) * width + j], length[i * width + j - 1]);
      }
    }
    std::vector<IndexPair> pairs;
    for (std::size_t i = matches.rows(), j = matches.columns(); i > 0 && j > 0;) {
      if (matches.test(i - 1, j - 1)) {
        pairs.push_back({--i, --j});
      } else if (length[(i - 1) * width + j] >= length[i * width + j - 1]) {
        --i;
      } else {
        --j;
      }
    }
    benchmark::DoNotOptimize(pairs);
  }
  set_sizes(state, matches.rows(), matches.columns());
}
BENCHMARK(BM_LcsByDynamicProgramming)->Unit(benchmark::kMillisecond);

/// An alignment of five rotations to three scans, from shapes to pose; the argument is the limit of ICP iterations.
void BM_Align(benchmark::State& state) {
  PaperOptions options;
  options.icp.max_iterations = static_cast<int>(state.range(0));
  options.icp.decoupled = options.icp.max_iterations > 0;
  const Shape query = full_shape(kQuery);
  std::vector<TargetScan> scans;  // what the mapper keeps of each scan
  for (const Shape& scan : target_scans()) scans.push_back(target_scan(scan, options.histogram.radius_m));
  for (auto _ : state) {
    const PartialMap target(scans);
    benchmark::DoNotOptimize(paper_align(target, query, options));
  }
  set_sizes(state, query.size(), 3 * kNumPoints);
}
BENCHMARK(BM_Align)->ArgName("icp_iterations")->Arg(0)->Arg(20)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace shapemap
