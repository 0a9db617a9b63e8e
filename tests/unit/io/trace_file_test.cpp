// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/io/trace_file.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "shapemap/core/errors.hpp"
#include "support/synthetic_world.hpp"
#include "support/temp_folder.hpp"

namespace shapemap {
namespace {

using Lines = std::vector<nlohmann::json>;

class TraceOfAWalk : public testing::Test {
 protected:
  TraceOfAWalk() {
    for (std::size_t i = 0; i < 4; ++i) {
      const auto k = static_cast<double>(i);
      log_.scans.push_back(test::scan_of(test::cluttered_room(2), {-0.4 + 0.15 * k, 0.02 * k * k, 0.02 * k}));
      log_.scans.back().timestamp_s = 10.0 + k;
    }
    selection_.skip = 7;
  }

  std::string path(const char* name = "trace.jsonl") const { return folder_.path(name); }

  MapResult write(const std::string& to) const {
    TraceFile trace(to, {{"odd\xFF.log"}, log_, options_, reading_, selection_});
    MapResult result = map_log(log_, options_, trace);
    trace.commit(result);
    return result;
  }

  static std::map<std::string, Lines> records(const std::string& from) {
    std::map<std::string, Lines> all;
    std::ifstream file(from);
    for (std::string line; std::getline(file, line);) {
      const auto record = nlohmann::json::parse(line);
      all[record.at("record")].push_back(record);
    }
    return all;
  }

  test::TempFolder folder_;
  Log log_;
  MappingOptions options_ = test::paper_options();
  LogReadOptions reading_;
  SelectionOptions selection_;
};

/// Compares the pairs that the file names with those of a match that is made anew, point by point.
struct Comparison : MappingEvents {
  void on_alignment(const TracedAlignment& traced) override {
    all.push_back(traced.steps.rotations.at(static_cast<std::size_t>(traced.steps.best_rotation)));
    targets.push_back(traced.targets);
  }
  std::vector<RotationMatch> all;
  std::vector<std::vector<TracedTarget>> targets;
};

TEST_F(TraceOfAWalk, NamesThePointsOfEachPair) {
  for (const LcsTarget target : {LcsTarget::kPerScan, LcsTarget::kConcatenated}) {
    options_.paper.lcs.target = target;
    std::filesystem::remove(path());
    write(path());
    auto traced = records(path());
    Comparison comparison;
    map_log(log_, options_, comparison);
    ASSERT_EQ(traced["alignment"].size(), 3U);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& record = traced["alignment"][k];
      const RotationMatch& match = comparison.all[k];
      ASSERT_EQ(record["lcs"].size(), match.lcs.size());
      ASSERT_GT(match.lcs.size(), 10U);
      EXPECT_EQ(record["spread"].size(), match.spread.size());
      EXPECT_EQ(record["segments"].size(), match.segments.size());
      EXPECT_EQ(record["kept"].size(), match.translation.kept.size());
      for (std::size_t i = 0; i < match.lcs.size(); ++i) {
        const std::size_t scan = record["lcs"][i][1];
        const auto& point = traced["position"].at(scan)["points"].at(record["lcs"][i][2].get<std::size_t>());
        Pose2 ref_from_robot;
        for (const TracedTarget& t : comparison.targets[k]) {
          if (t.scan_index == scan) ref_from_robot = t.ref_from_robot;
        }
        const Point2 p_m = ref_from_robot * Point2(point[0], point[1]);
        EXPECT_NEAR((p_m - match.lcs[i].target_m).norm(), 0.0, 1e-9) << enum_name(target) << " " << k << " " << i;
      }
    }
  }
}

TEST_F(TraceOfAWalk, HasARecordForEachStep) {
  const MapResult result = write(path());
  auto traced = records(path());
  ASSERT_EQ(traced["run"].size(), 1U);
  EXPECT_EQ(traced["run"][0]["format"], "shapemap-trace");
  EXPECT_EQ(traced["run"][0]["format_version"], 1);
  EXPECT_EQ(traced["run"][0]["options"]["method"], "paper");
  EXPECT_FALSE(traced["run"][0]["options"].contains("threads"));
  ASSERT_EQ(traced["position"].size(), 4U);
  const auto& scan = traced["position"][2];
  EXPECT_EQ(scan["index_in_whole_log"], 9);
  EXPECT_EQ(scan["timestamp_s"], 12.0);
  const auto& sweep = scan["sub_scans"].at(0);
  EXPECT_EQ(sweep["scan_points"].size(), sweep["closest_segment"].size());
  EXPECT_GT(sweep["segments"].size(), 3U);
  EXPECT_EQ(scan["histograms"].size(), scan["points"].size());
  ASSERT_EQ(traced["result"].size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(traced["result"][i]["fragment_from_robot"][0], result.placed().at(i).map_from_robot.x_m);
  }
  EXPECT_TRUE(traced["result"][0]["status"].is_null());
  EXPECT_EQ(traced["result"][1]["status"], "ok");
  ASSERT_EQ(traced["end"].size(), 1U);
  EXPECT_EQ(traced["end"][0]["num_placed"], 4);
}

TEST_F(TraceOfAWalk, HoldsTheHistogramsThatMatchingSees) {
  write(path());
  const auto scan = records(path())["position"][1];
  const Shape shape = test::shape_of(log_.scans[1], options_);
  const auto expected = NeighbourDirections(shape, 0.50).histograms(0.0, HistogramNorm::kMaximum);
  ASSERT_EQ(scan["histograms"].size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    AngularHistogram read;
    const auto& bins = scan["histograms"][i];
    for (std::size_t k = 0; k + 1 < bins.size(); k += 2) read.bins.at(bins[k].get<std::size_t>()) = bins[k + 1];
    EXPECT_EQ(read.bins, expected[i].bins) << i;
  }
}

TEST_F(TraceOfAWalk, HasTheCandidatesOfTheRobustMethod) {
  options_.run.method = Method::kRobust;
  options_.robust.keyframes.step_m = 0.0;  // each scan is matched with the one before it
  write(path());
  auto traced = records(path());
  EXPECT_EQ(traced.count("alignment"), 0U);
  ASSERT_EQ(traced["link"].size(), 3U);
  ASSERT_EQ(traced["choice"].size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t candidate = traced["choice"][k]["alternative"];
    const auto& chosen = traced["link"][k]["hypotheses"].at(candidate);
    const auto& result = traced["result"][k + 1];
    EXPECT_EQ(chosen["covariance"], result["covariance"]);
    EXPECT_EQ(chosen["pose"], result["ref_from_query"]);
    EXPECT_GT(result["probability"], 0.0);
    EXPECT_EQ(traced["link"][k]["view_shortfall"], 0.0) << "the laser looks all round";
  }
}

TEST_F(TraceOfAWalk, TellsHowEdgesInDoubtWereJudged) {
  options_.run.method = Method::kRobust;
  options_.robust.keyframes.step_m = 0.0;
  options_.robust.edge_verification.doubt_below = 1.0;  // all edges are in doubt
  const MapResult mapped = write(path());
  auto traced = records(path());
  ASSERT_EQ(traced["revision"].size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& revision = traced["revision"][k];
    const auto& candidates = revision["hypotheses"];
    ASSERT_GE(candidates.size(), traced["link"][k]["hypotheses"].size());
    EXPECT_EQ(candidates[0]["pose"], traced["link"][k]["hypotheses"][0]["pose"]) << "new ones come behind";
    for (const auto& candidate : candidates) {
      EXPECT_GE(candidate["for_it"], 0.0);
      EXPECT_GE(candidate["against_it"], 0.0);
      EXPECT_GE(candidate["vouched"], 0.0);
    }
    EXPECT_LT(revision["in_map"], candidates.size());
    EXPECT_EQ(revision["alternative"], traced["choice"][k]["alternative"]);
    EXPECT_EQ(revision["probability"], mapped.scans[k + 1].match.probability);
  }
}

TEST_F(TraceOfAWalk, IsCompressedWhenItsNameSaysSo) {
  write(path("trace.jsonl.gz"));
  gzFile file = gzopen(path("trace.jsonl.gz").c_str(), "rb");
  ASSERT_NE(file, nullptr);
  EXPECT_EQ(gzdirect(file), 0);
  std::string start(16, ' ');
  EXPECT_EQ(gzread(file, start.data(), 16), 16);
  EXPECT_EQ(start, "{\"record\":\"run\",");
  gzclose(file);
}

TEST_F(TraceOfAWalk, IsNoFileWithoutACommit) {
  { TraceFile trace(path(), {{"a.log"}, log_, options_, reading_, selection_}); }
  EXPECT_FALSE(std::filesystem::exists(path()));
  EXPECT_THROW(TraceFile(path("no/such/folder.jsonl"), {{"a.log"}, log_, options_, reading_, selection_}), OutputError);
}

}  // namespace
}  // namespace shapemap
