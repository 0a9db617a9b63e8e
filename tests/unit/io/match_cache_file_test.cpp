// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/io/match_cache_file.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>

#include "shapemap/core/errors.hpp"
#include "shapemap/core/parallel_for.hpp"
#include "support/synthetic_world.hpp"
#include "support/temp_folder.hpp"

namespace shapemap {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::size_t kRecordBytes = 8 + 24 + 208;  // bytes of a record with one candidate

Log log_of(std::size_t num_scans) {
  Log log;
  for (std::size_t i = 0; i < num_scans; ++i) {
    test::Scanner scanner;
    scanner.num_beams = 20;
    log.scans.push_back(test::scan_of(test::uneven_room(), {0.1 * static_cast<double>(i), 0.0, 0.0}, scanner));
  }
  return log;
}

/// The numbers would not survive as text, and are all different.
MatchCandidate candidate(double seed) {
  MatchCandidate h;
  h.ref_from_query = {seed / 3.0, -0.0, std::nextafter(seed, 10.0)};
  h.score = -seed * 1e-300;
  h.visibility = {seed + 0.1, seed + 0.2, seed + 0.3, seed + 0.4, seed + 0.5, seed + 0.6, seed + 0.7};
  h.fit.ref_from_query = {1.0 / seed, std::numeric_limits<double>::denorm_min(), -seed};
  for (Eigen::Index i = 0; i < 9; ++i) h.fit.information(i / 3, i % 3) = seed / static_cast<double>(7 + i);
  h.fit.partners = 37;
  h.fit.rms_m = std::numeric_limits<double>::denorm_min();
  h.fit.lever_m = std::nextafter(seed, 10.0);
  return h;
}

std::vector<double> numbers(const MatchCandidate& h) {
  std::vector<double> all{h.ref_from_query.x_m,
                          h.ref_from_query.y_m,
                          h.ref_from_query.theta_rad,
                          h.score,
                          h.visibility.agree,
                          h.visibility.crossed,
                          h.visibility.hidden,
                          h.visibility.unclear,
                          h.visibility.outside,
                          h.visibility.cross_agree,
                          h.visibility.cross_total,
                          h.fit.ref_from_query.x_m,
                          h.fit.ref_from_query.y_m,
                          h.fit.ref_from_query.theta_rad,
                          h.fit.rms_m,
                          h.fit.lever_m,
                          static_cast<double>(h.fit.partners)};
  for (Eigen::Index i = 0; i < 9; ++i) all.push_back(h.fit.information(i / 3, i % 3));
  return all;
}

MATCHER_P(HasSameBitsAs, expected, "") {
  const std::vector<double> a = numbers(arg);
  const std::vector<double> b = numbers(expected);
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

class MatchCacheFileTest : public ::testing::Test {
 protected:
  MatchCacheFile opened(StateOpening opening) const { return {path_, opening, log_, options_}; }

  /// Makes a file with the matches of scan 0 with 1, 2 and 3.
  void make_three() const {
    MatchCacheFile state = opened(StateOpening::kCreate);
    for (std::size_t i = 1; i <= 3; ++i) state.keep({0, i}, {candidate(static_cast<double>(i))});
  }

  std::string why_not_resumed() const {
    const std::string before = test::read_file(path_);
    try {
      opened(StateOpening::kResume);
    } catch (const InputError& e) {
      EXPECT_EQ(test::read_file(path_), before);
      EXPECT_THAT(e.what(), HasSubstr(path_));
      return e.what();
    }
    return "";
  }

  test::TempFolder folder_;
  std::string path_ = folder_.path("run.state");
  Log log_ = log_of(5);
  MappingOptions options_;
};

TEST_F(MatchCacheFileTest, GivesBackEveryBitInTheSameRunAndInTheNext) {
  const std::vector<MatchCandidate> kept{candidate(1.5), candidate(2.5)};
  {
    MatchCacheFile state = opened(StateOpening::kCreate);
    EXPECT_FALSE(state.find({0, 1}));
    state.keep({0, 1}, kept);
    ASSERT_TRUE(state.find({0, 1}));
    EXPECT_EQ(state.num_resumed(), 0U);
  }
  MatchCacheFile state = opened(StateOpening::kResume);
  EXPECT_EQ(state.num_resumed(), 1U);
  EXPECT_THAT(state.warning(), IsEmpty());
  const auto found = state.find({0, 1});
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 2U);
  EXPECT_THAT((*found)[0], HasSameBitsAs(kept[0]));
  EXPECT_THAT((*found)[1], HasSameBitsAs(kept[1]));
}

TEST_F(MatchCacheFileTest, TellsDirectionsAndSearchesApart) {
  MatchCacheFile state = opened(StateOpening::kCreate);
  state.keep({1, 2, SearchKind::kFull}, {});
  EXPECT_TRUE(state.find({1, 2, SearchKind::kFull}));
  EXPECT_FALSE(state.find({1, 2, SearchKind::kMultiReference}));
  EXPECT_FALSE(state.find({1, 2, SearchKind::kLoop}));
  EXPECT_FALSE(state.find({2, 1, SearchKind::kFull}));
}

TEST_F(MatchCacheFileTest, KnowsThatNothingWasFound) {
  opened(StateOpening::kCreate).keep({1, 2}, {});
  const auto found = opened(StateOpening::kResume).find({1, 2});
  ASSERT_TRUE(found);
  EXPECT_THAT(*found, IsEmpty());
}

TEST_F(MatchCacheFileTest, KeepsEachMatchOnce) {
  MatchCacheFile state = opened(StateOpening::kCreate);
  state.keep({0, 1}, {candidate(1)});
  const auto size = std::filesystem::file_size(path_);
  state.keep({0, 1}, {candidate(1)});
  EXPECT_EQ(std::filesystem::file_size(path_), size);
}

TEST_F(MatchCacheFileTest, WritesAtOnce) {
  MatchCacheFile state = opened(StateOpening::kCreate);
  const auto size = std::filesystem::file_size(path_);
  state.keep({0, 1}, {candidate(1)});
  EXPECT_EQ(std::filesystem::file_size(path_), size + kRecordBytes);
}

TEST_F(MatchCacheFileTest, TakesManyThreads) {
  log_ = log_of(400);
  const auto of = [](std::size_t i) { return candidate(1.0 + 0.01 * static_cast<double>(i)); };
  {
    MatchCacheFile state = opened(StateOpening::kCreate);
    parallel_for(400, 4, [&](std::size_t i) {
      state.keep({i, 399 - i}, {of(i)});
      if (!state.find({i, 399 - i})) throw std::runtime_error("lost");
    });
  }
  MatchCacheFile state = opened(StateOpening::kResume);
  EXPECT_EQ(state.num_resumed(), 400U);
  for (std::size_t i = 0; i < 400; ++i) {
    EXPECT_THAT(state.find({i, 399 - i})->front(), HasSameBitsAs(of(i)));
  }
}

TEST_F(MatchCacheFileTest, CutAnywhereKeepsWhatIsWholeAndGoesOn) {
  make_three();
  const std::string whole = test::read_file(path_);
  const std::size_t header = whole.size() - 3 * kRecordBytes;
  for (std::size_t size = 0; size < whole.size(); size += size < header ? 101 : 1) {
    folder_.write("run.state", whole.substr(0, size));
    const std::size_t num_whole = size < header ? 0 : (size - header) / kRecordBytes;
    {
      MatchCacheFile state = opened(StateOpening::kResume);
      ASSERT_EQ(state.num_resumed(), num_whole) << size;
      const bool at_border = size >= header && (size - header) % kRecordBytes == 0;
      ASSERT_EQ(state.warning().empty(), at_border) << size;
      for (std::size_t i = 1; i <= 3; ++i) state.keep({0, i}, {candidate(static_cast<double>(i))});
    }
    ASSERT_EQ(test::read_file(path_), whole) << size;
  }
}

TEST_F(MatchCacheFileTest, AFlippedBitAnywhereCostsWhatComesAfterIt) {
  make_three();
  const std::string whole = test::read_file(path_);
  const std::size_t header = whole.size() - 3 * kRecordBytes;
  for (std::size_t at = header; at < whole.size(); ++at) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << (at % 8)));
    folder_.write("run.state", damaged);
    const MatchCacheFile state = opened(StateOpening::kResume);
    ASSERT_EQ(state.num_resumed(), (at - header) / kRecordBytes) << at;
    ASSERT_THAT(state.warning(), AllOf(HasSubstr(path_), HasSubstr("damaged"))) << at;
  }
}

TEST_F(MatchCacheFileTest, AFlippedBitInTheHeaderIsAnError) {
  make_three();
  const std::string whole = test::read_file(path_);
  for (std::size_t at = 0; at < whole.size() - 3 * kRecordBytes; ++at) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << (at % 8)));
    folder_.write("run.state", damaged);
    ASSERT_THAT(why_not_resumed(), HasSubstr("cannot resume")) << at;
  }
}

TEST_F(MatchCacheFileTest, ATailOfZerosIsCutOff) {
  make_three();
  folder_.write("run.state", test::read_file(path_) + std::string(4096, '\0'));
  const MatchCacheFile state = opened(StateOpening::kResume);
  EXPECT_EQ(state.num_resumed(), 3U);
  EXPECT_THAT(state.warning(), HasSubstr("the 3 alignments before it are used"));
}

TEST_F(MatchCacheFileTest, NamesWhatDiffers) {
  make_three();
  const Log log = log_;
  log_.scans.pop_back();
  EXPECT_THAT(why_not_resumed(), AllOf(HasSubstr("another log"), HasSubstr("of 5, not 4")));
  log_ = log;
  log_.scans[2].sweeps[0].ranges_m[7] += 0.001F;
  EXPECT_THAT(why_not_resumed(), AllOf(HasSubstr("another log"), HasSubstr("just as many")));
  log_ = log;
  log_.scans[2].sweeps[0].robot_from_sensor.yaw_rad = 0.1;
  EXPECT_THAT(why_not_resumed(), HasSubstr("another log"));
  log_ = log;
  options_.robust.matcher.search.visibility.agree_tangent_rad = 30 * kDegree;
  EXPECT_THAT(why_not_resumed(), HasSubstr("--agree-tangent-deg 25 instead of 30"));
  options_ = {};
  options_.polylines.run_gap_m = std::nextafter(options_.polylines.run_gap_m, 1.0);
  EXPECT_THAT(why_not_resumed(), HasSubstr("--"));
}

TEST_F(MatchCacheFileTest, AskedForWithOtherOptionsThatDoNotMatterIsTheSame) {
  make_three();
  options_.run.threads = 7;
  options_.robust.loops.close_loops = false;
  options_.robust.keyframes.step_m = 0.1;
  options_.robust.matcher.confidence.sure_probability = 0.5;
  log_.scans[0].timestamp_s = 77.0;
  EXPECT_EQ(opened(StateOpening::kResume).num_resumed(), 3U);
}

TEST_F(MatchCacheFileTest, IsNotWhateverFileThereIs) {
  EXPECT_THROW(opened(StateOpening::kResume), InputError);
  EXPECT_FALSE(std::filesystem::exists(path_));
  for (const std::string& content : {std::string("x"), std::string("FLASER 180 1.0"), std::string(100000, 'y')}) {
    folder_.write("run.state", content);
    EXPECT_THAT(why_not_resumed(), HasSubstr("not a state"));
  }
}

TEST_F(MatchCacheFileTest, OfAFormatToComeIsAnError) {
  make_three();
  std::string content = test::read_file(path_);
  content[12] = 9;
  folder_.write("run.state", content);
  EXPECT_THAT(why_not_resumed(), HasSubstr("has format 9, this shapemap reads 1"));
}

TEST_F(MatchCacheFileTest, IsReplacedOnlyWhenAskedFor) {
  make_three();
  const std::string before = test::read_file(path_);
  EXPECT_THROW(opened(StateOpening::kCreate), OutputError);
  EXPECT_EQ(test::read_file(path_), before);
  opened(StateOpening::kReplace);
  EXPECT_EQ(opened(StateOpening::kResume).num_resumed(), 0U);
}

TEST_F(MatchCacheFileTest, BelongsToOneRunAtATime) {
  const MatchCacheFile first = opened(StateOpening::kCreate);
  EXPECT_THROW(opened(StateOpening::kResume), OutputError);
  EXPECT_THROW(opened(StateOpening::kReplace), OutputError);
}

TEST_F(MatchCacheFileTest, NeedsAFile) {
  path_ = "/dev/full";
  EXPECT_THROW(opened(StateOpening::kReplace), OutputError);
  path_ = folder_.path("no/run.state");
  EXPECT_THROW(opened(StateOpening::kCreate), OutputError);
}

}  // namespace
}  // namespace shapemap
