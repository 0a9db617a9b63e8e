// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstring>
#include <random>

#include "support/logs.hpp"
#include "support/temp_folder.hpp"

namespace shapemap {
namespace {

#ifdef __SANITIZE_ADDRESS__
constexpr long kMaxGrowth_KiB = 1024 * 1024;  // AddressSanitizer keeps freed memory for a while, by default 256 MiB
#else
constexpr long kMaxGrowth_KiB = 64 * 1024;
#endif

using test::input_error;
using test::make_sweep;
using test::TempFolder;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr int kNumScans = 4;

class RawlogDamage : public testing::Test {
 protected:
  RawlogDamage() {
    Log log;
    LogPoses poses;
    for (int i = 0; i < kNumScans; ++i) {
      Scan scan;
      scan.timestamp_s = 100.0 + i;
      scan.sweeps = {make_sweep(50, -1.0, 0.02), make_sweep(50, 0.5, 0.02)};
      log.scans.push_back(scan);
      poses.map_from_robot.push_back({0.1 * i, 0.0, 0.0});
    }
    write_log(log, folder_.path("whole.rawlog"), LogFormat::kRawlog, &poses);
    content_ = test::read_gz(folder_.path("whole.rawlog"));
  }

  /// Finds the n-th place where the number of beams stands in front of the first reading.
  std::size_t beam_count_offset() const {
    const std::uint32_t count = 50;
    const float first = 1.0F;
    std::string pattern(8, '\0');
    std::memcpy(pattern.data(), &count, 4);
    std::memcpy(pattern.data() + 4, &first, 4);
    return content_.find(pattern);
  }

  TempFolder folder_;
  std::string content_;
};

TEST_F(RawlogDamage, UncompressedIsReadAsWell) {
  const Log log = read_log(folder_.write("plain.rawlog", content_));
  EXPECT_EQ(log.scans.size(), 4U);
  EXPECT_TRUE(log.warnings.empty());
}

TEST_F(RawlogDamage, CutAnywhereGivesWhatIsWhole) {
  std::size_t most = 0;
  for (std::size_t length = 1; length < content_.size(); length += 7) {
    const std::string path = folder_.write("cut.rawlog", content_.substr(0, length));
    try {
      const Log log = read_log(path);
      ASSERT_GE(log.scans.size(), most);
      most = log.scans.size();
      for (const Scan& scan : log.scans) ASSERT_EQ(scan.sweeps.size(), 2U);
      // A cut just between two entries, or behind an end mark, cannot be detected.
      if (!log.warnings.empty()) {
        EXPECT_THAT(log.warnings, ElementsAre(AllOf(HasSubstr("whole entries"), HasSubstr("offset"))));
      }
    } catch (const InputError&) {
      ASSERT_EQ(most, 0U) << "at " << length;
    }
  }
  EXPECT_EQ(most, 3U);
}

TEST_F(RawlogDamage, CutInsideAScanIsReported) {
  const Log log = read_log(folder_.write("cut.rawlog", content_.substr(0, content_.size() - 100)));
  EXPECT_EQ(log.scans.size(), 3U);
  EXPECT_THAT(log.warnings, ElementsAre(AllOf(HasSubstr("after 7 whole entries"), HasSubstr("offset"))));
}

TEST_F(RawlogDamage, CutGzipIsReported) {
  const std::string compressed = test::read_file(folder_.path("whole.rawlog"));
  const Log log = read_log(folder_.write("cut.rawlog", compressed.substr(0, compressed.size() - 60)));
  EXPECT_GE(log.scans.size(), 1U);
  EXPECT_LT(log.scans.size(), 4U);
  EXPECT_THAT(log.warnings, ElementsAre(AllOf(HasSubstr("whole entries"), HasSubstr("the gzip data is cut off"))));
  EXPECT_THAT(input_error(folder_.write("cut.rawlog", compressed.substr(0, 40))), HasSubstr("cut.rawlog"));
}

TEST_F(RawlogDamage, ABillionBeamsAskForNoMemory) {
  struct rusage before {};
  getrusage(RUSAGE_SELF, &before);
  for (const std::uint32_t count : {1'000'000'000U, 0xFFFFFFFFU, 999'999U}) {
    std::string content = content_;
    ASSERT_NE(beam_count_offset(), std::string::npos);
    std::memcpy(content.data() + beam_count_offset(), &count, 4);
    EXPECT_THAT(input_error(folder_.write("a.rawlog", content)), HasSubstr("no whole scan before that"));
  }
  struct rusage after {};
  getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, kMaxGrowth_KiB);
}

TEST_F(RawlogDamage, RandomBitsNeverDoMoreThanAnInputError) {
  std::mt19937 rng(3);
  std::uniform_int_distribution<std::size_t> where(0, content_.size() - 1);
  struct rusage before {};
  getrusage(RUSAGE_SELF, &before);
  for (int run = 0; run < 3000; ++run) {
    std::string content = content_;
    for (int flips = 1 + static_cast<int>(rng() % 4U); flips > 0; --flips) {
      content[where(rng)] ^= static_cast<char>(1U << (rng() % 8U));
    }
    try {
      EXPECT_LE(read_log(folder_.write("a.rawlog", content)).scans.size(), 8U);
    } catch (const InputError&) {
    }
  }
  struct rusage after {};
  getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, kMaxGrowth_KiB);
}

}  // namespace
}  // namespace shapemap
