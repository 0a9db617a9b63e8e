// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/io/report.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace shapemap {
namespace {

using Json = nlohmann::json;

/// Of three scans, the first two make the map, and the third could not be matched.
class Report : public testing::Test {
 protected:
  Report() {
    for (const double timestamp_s : {10.0, 11.0, 12.5}) log_.scans.push_back({timestamp_s, {Sweep{}}, {}, {}});
    log_.format = "carmen";
    result_.components.resize(2);
    result_.components[0].scans = {{0, 10.0, {}, {Pose2{}}}, {1, 11.0, {1.0, 2.0, kPi / 2}, {Pose2{}}}};
    result_.components[1].scans = {{2, 12.5, {}, {Pose2{}}}};
    result_.largest_component = 0;
    result_.scans.resize(3);
    for (std::size_t i = 0; i < 3; ++i) result_.scans[i].scan_index = i;
    result_.scans[0].component = 0;
    result_.scans[0].starts_component = true;
    result_.scans[1].component = 0;
    PaperAlignment& trusted = result_.scans[1].paper.emplace();
    trusted.status = PaperStatus::kOk;
    trusted.ref_from_query = {1.0, 2.0, kPi / 2};
    trusted.shape_ref_from_query = {0.9, 2.0, kPi / 2};
    trusted.overlap = 77;
    trusted.overlap_ratio = 0.75;
    trusted.query_from_sweep = {Pose2{0.01, 0.0, 0.0}};
    result_.scans[2].component = 1;
    result_.scans[2].starts_component = true;
    result_.scans[2].reason = "only 3 of 10";
    PaperAlignment& refused = result_.scans[2].paper.emplace();
    refused.status = PaperStatus::kTooFewCorrespondences;
    refused.ref_from_query = {std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0};
    refused.shape_ref_from_query = {0.5, 0.0, 0.0};
    selection_.skip = 5;
    selection_.every = 2;
  }
  Json parsed() const {
    return Json::parse(json_report({logs_,
                                    log_,
                                    result_,
                                    mapping_,
                                    reading_,
                                    selection_,
                                    grid_,
                                    {"odd"},
                                    {1.0, 2.0, 3.0, 6.5, 6.0, 50.0, {{1008, 4.0, 7.5, 40.0}}},
                                    {},
                                    walls_,
                                    {{0, 1000, 12}}}));
  }

  std::vector<LogFile> logs_{{"run\xFF.log", "carmen"}};
  Log log_;
  MapResult result_;
  MappingOptions mapping_;
  LogReadOptions reading_;
  SelectionOptions selection_;
  OccupancyGridOptions grid_;
  std::vector<WallDirection> walls_;
};

TEST_F(Report, TellsWhatBecameOfEachScan) {
  const Json report = parsed();
  EXPECT_EQ(report["num_scans"], 3);
  EXPECT_EQ(report["num_placed"], 2);
  const Json& first = report["scans"][0];
  EXPECT_TRUE(first["alignment"].is_null()) << "there was nothing to align to";
  EXPECT_EQ(first["map_from_robot"]["x_m"], 0.0);
  const Json& second = report["scans"][1];
  EXPECT_EQ(second["index_in_whole_log"], 7);
  EXPECT_EQ(second["alignment"]["status"], "ok");
  EXPECT_DOUBLE_EQ(second["alignment"]["ref_from_query"]["theta_deg"], 90.0);
  EXPECT_EQ(second["alignment"]["shape_ref_from_query"]["x_m"], 0.9);
  EXPECT_EQ(second["alignment"]["overlap"], 77);
  EXPECT_EQ(second["alignment"]["overlap_ratio"], 0.75);
  EXPECT_EQ(second["alignment"]["query_from_sweep"][0]["x_m"], 0.01);
  EXPECT_EQ(second["map_from_robot"]["y_m"], 2.0);
  const Json& third = report["scans"][2];
  EXPECT_EQ(third["alignment"]["status"], "too-few-correspondences");
  EXPECT_EQ(third["reason"], "only 3 of 10");
  EXPECT_TRUE(third["alignment"]["ref_from_query"].is_null());
  EXPECT_TRUE(third["alignment"]["shape_ref_from_query"].is_null());
  EXPECT_TRUE(third["map_from_robot"].is_null());
}

TEST_F(Report, TellsWhatThePicturesShowAndHowFarTheyAreTurned) {
  const Json plain = parsed()["components"];
  EXPECT_EQ(plain[0]["picture"], Json::parse(R"({"num_returns": 1000, "num_outside": 12})"));
  EXPECT_TRUE(plain[1]["picture"].is_null()) << "it was not drawn";
  EXPECT_TRUE(plain[0]["walls"].is_null()) << "it was not asked for";
  walls_ = {{-30 * kDegree, 0.8, 0.1}, {20 * kDegree, 0.3, 0.2}};
  const Json turned = parsed()["components"];
  EXPECT_NEAR(turned[0]["walls"]["turned_deg"], 30.0, 1e-9);
  EXPECT_EQ(turned[0]["walls"]["share"], 0.8);
  EXPECT_EQ(turned[1]["walls"]["turned_deg"], 0.0) << "no direction dominates";
  EXPECT_EQ(turned[1]["walls"]["rival_share"], 0.2);
  EXPECT_EQ(parsed()["options"]["align-walls"], false);
}

TEST_F(Report, OfThePapersMethodHasNoProbability) {
  const Json match = parsed()["scans"][1]["alignment"];
  EXPECT_TRUE(match["probability"].is_null());
  EXPECT_TRUE(match["covariance"].is_null());
  EXPECT_TRUE(match["ranked"].empty());
}

TEST_F(Report, TellsHowSureAPoseIsAndWhatElseItMightBe) {
  result_.scans[1].paper.reset();
  ScanMatch& match = result_.scans[1].match;
  match.ref_from_query = {1.0, 2.0, kPi / 2};
  for (const MatchStatus status : {MatchStatus::kOk, MatchStatus::kAmbiguous, MatchStatus::kDegenerate}) {
    match.status = status;
    match.probability = 0.75;
    match.covariance << 1.0, 2.0, 3.0, 2.0, 5.0, 6.0, 3.0, 6.0, 9.0;
    match.ranked = {{match.ref_from_query, 3.5, 0.6, 0.1}, {{-1.0, 0.0, 0.0}, 3.25, 0.5, 0.2}};
    const Json shown = parsed()["scans"][1]["alignment"];
    EXPECT_EQ(shown["status"], enum_name(status));
    EXPECT_EQ(shown["ref_from_query"]["x_m"], 1.0) << "a pose in doubt is a pose";
    EXPECT_TRUE(shown["shape_ref_from_query"].is_null());
    EXPECT_EQ(shown["overlap_ratio"], 0.6) << "of the pose that was taken";
    EXPECT_EQ(shown["probability"], 0.75);
    EXPECT_EQ(shown["covariance"], Json::parse("[[1, 2, 3], [2, 5, 6], [3, 6, 9]]"));
    ASSERT_EQ(shown["ranked"].size(), 2U);
    EXPECT_EQ(shown["ranked"][1]["ref_from_query"]["x_m"], -1.0);
    EXPECT_EQ(shown["ranked"][1]["score"], 3.25);
    EXPECT_EQ(shown["ranked"][1]["agree"], 0.5);
    EXPECT_EQ(shown["ranked"][1]["crossed"], 0.2);
  }
}

TEST_F(Report, ShowsNoPoseWhereNoneIsTrusted) {
  result_.scans[1].paper->status = PaperStatus::kTooLittleOverlap;
  EXPECT_TRUE(parsed()["scans"][1]["alignment"]["ref_from_query"].is_null());
  result_.scans[1].paper.reset();
  ScanMatch& match = result_.scans[1].match;
  match.status = MatchStatus::kTooLittleOverlap;
  match.ref_from_query = {1.0, 2.0, kPi / 2};
  match.reason = result_.scans[1].reason = "they share nothing";
  EXPECT_EQ(parsed()["scans"][1]["alignment"]["status"], "too-little-overlap");
  EXPECT_TRUE(parsed()["scans"][1]["alignment"]["ref_from_query"].is_null());
}

TEST_F(Report, ListsComponentsAndWhichOneIsTheMap) {
  const Json components = parsed()["components"];
  ASSERT_EQ(components.size(), 2U);
  EXPECT_EQ(components[0]["num_scans"], 2);
  EXPECT_EQ(components[0]["last_index"], 1);
  EXPECT_EQ(components[0]["is_map"], true);
  EXPECT_EQ(components[1]["first_index"], 2);
  EXPECT_EQ(components[1]["is_map"], false);
}

TEST_F(Report, TellsWhichLogEachScanIsFrom) {
  logs_.push_back({"other.rawlog", "rawlog"});
  log_.starts = {1};
  const Json report = parsed();
  ASSERT_EQ(report["logs"].size(), 2U);
  EXPECT_EQ(report["logs"][0]["num_scans"], 1);
  EXPECT_EQ(report["logs"][0]["num_placed"], 1);
  EXPECT_EQ(report["logs"][1]["path"], "other.rawlog");
  EXPECT_EQ(report["logs"][1]["format"], "rawlog");
  EXPECT_EQ(report["logs"][1]["first_index"], 1);
  EXPECT_EQ(report["logs"][1]["num_scans"], 2);
  EXPECT_EQ(report["logs"][1]["num_placed"], 1);
  EXPECT_EQ(report["logs"][1]["duration_s"], 1.5);
  EXPECT_EQ(report["scans"][0]["log"], 0);
  EXPECT_EQ(report["scans"][1]["log"], 1);
  EXPECT_EQ(report["scans"][1]["index_in_whole_log"], 5) << "the first that is left of the second log";
  EXPECT_EQ(report["scans"][2]["index_in_whole_log"], 7);
  EXPECT_EQ(report["components"][0]["logs"],
            Json::parse(R"([{"log": 0, "num_scans": 1}, {"log": 1, "num_scans": 1}])"));
  EXPECT_EQ(report["components"][1]["logs"], Json::parse(R"([{"log": 1, "num_scans": 1}])"));
}

TEST_F(Report, TellsLoopsAndWhatTheyHold) {
  result_.loops.push_back({0, 1, {1.0, 2.0, kPi / 2}, 12.5});
  result_.scans[1].loop_constrained = true;
  result_.times.loops_s = 0.25;
  const Json report = parsed();
  ASSERT_EQ(report["loops"].size(), 1U);
  EXPECT_EQ(report["loops"][0]["a"], 0);
  EXPECT_EQ(report["loops"][0]["b"], 1);
  EXPECT_DOUBLE_EQ(report["loops"][0]["a_from_b"]["theta_deg"], 90.0);
  EXPECT_EQ(report["loops"][0]["strength"], 12.5);
  EXPECT_EQ(report["scans"][0]["loop_constrained"], false);
  EXPECT_EQ(report["scans"][1]["loop_constrained"], true);
  EXPECT_EQ(report["seconds"]["loops"], 0.25);
  EXPECT_EQ(report["interrupted"], false);
}

TEST_F(Report, TellsHowEachScanGoesWithTheRest) {
  result_.components[0].scans[1].consistency = {0.5, 0.25, 0.125, true};
  result_.components[1].scans[0].consistency = {0.0, 0.0, 1.0, true};
  result_.scans.emplace_back().scan_index = 3;
  log_.scans.push_back({13.0, {Sweep{}}, {}, {}});
  result_.times.consistency_s = 0.5;
  const Json report = parsed();
  EXPECT_EQ(report["num_contradicting"], 1) << "of those in the map";
  const Json wanted = Json::parse(R"({"agree": 0.5, "through": 0.25, "in_free": 0.125, "contradicts_map": true})");
  EXPECT_EQ(report["scans"][1]["consistency"], wanted);
  EXPECT_EQ(report["scans"][0]["consistency"]["contradicts_map"], false);
  EXPECT_EQ(report["scans"][2]["consistency"]["in_free"], 1.0) << "with its own component";
  EXPECT_TRUE(report["scans"][3]["consistency"].is_null()) << "in no component";
  EXPECT_EQ(report["seconds"]["consistency"], 0.5);
}

TEST_F(Report, TellsTheKeyframeThatAScanIsMatchedWith) {
  result_.scans[1].is_keyframe = false;
  const Json scans = parsed()["scans"];
  EXPECT_EQ(scans[0]["is_keyframe"], true);
  EXPECT_EQ(scans[1]["is_keyframe"], false);
  EXPECT_EQ(scans[1]["alignment"]["reference"], 0);
  EXPECT_EQ(scans[2]["alignment"]["reference"], 0) << "the one between stands for nothing";
}

TEST_F(Report, SaysThatARunWasCutShort) {
  result_.interrupted = true;
  EXPECT_EQ(parsed()["interrupted"], true);
}

TEST_F(Report, HoldsEveryOptionInTheUnitOfItsName) {
  mapping_.returns.max_mount_tilt_rad = 25 * kDegree;
  grid_.resolution_m = 0.02;
  const Json options = parsed()["options"];
  EXPECT_NEAR(options["max-mount-tilt-deg"].get<double>(), 25.0, 1e-12);
  EXPECT_EQ(options["resolution-m"], 0.02);
  EXPECT_EQ(options["method"], "robust");
  EXPECT_EQ(options["skip"], 5);
  MappingOptions::groups(mapping_, [&](const char* title, const auto& group) {
    std::decay_t<decltype(group)>::fields(group, [&](const Field& field, const auto&) {
      EXPECT_TRUE(options.contains(field.name)) << title << ": " << field.name;
    });
  });
}

TEST_F(Report, NamesVersionsCostsAndTheLogWhateverItsBytes) {
  const Json report = parsed();
  for (const char* name : {"shapemap", "MRPT", "OpenCV", "CGAL", "Eigen"}) {
    EXPECT_NE(report["versions"][name].get<std::string>().find('.'), std::string::npos) << name;
  }
  EXPECT_EQ(report["seconds"]["wall"], 6.5);
  EXPECT_EQ(report["peak_memory_mib"], 50.0);
  ASSERT_EQ(report["milestones"].size(), 1U);
  EXPECT_EQ(report["milestones"][0]["num_scans"], 1008);
  EXPECT_EQ(report["milestones"][0]["wall_s"], 4.0);
  EXPECT_EQ(report["milestones"][0]["cpu_s"], 7.5);
  EXPECT_EQ(report["milestones"][0]["peak_memory_mib"], 40.0);
  EXPECT_EQ(report["warnings"][0], "odd");
  EXPECT_EQ(report["logs"][0]["path"], "run\xEF\xBF\xBD.log") << "bytes that are no UTF-8 are replaced";
}

}  // namespace
}  // namespace shapemap
