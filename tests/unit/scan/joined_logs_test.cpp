// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/scan/joined_logs.hpp"

#include <gtest/gtest.h>

namespace shapemap {
namespace {

Log log_of(std::size_t count, const std::string& format, double first_s) {
  Log log;
  log.format = format;
  log.warnings = {format + " is odd"};
  for (std::size_t i = 0; i < count; ++i) log.scans.push_back({first_s + static_cast<double>(i), {}, {}, {}});
  return log;
}

TEST(JoinedLogs, HasAllScansInOrderAndKnowsWhereEachLogBegins) {
  const Log all = joined_logs({log_of(3, "carmen", 0.0), log_of(2, "rawlog", 0.0), log_of(4, "carmen", 50.0)});
  EXPECT_EQ(all.format, "carmen+rawlog");
  EXPECT_EQ(all.warnings, (std::vector<std::string>{"carmen is odd", "rawlog is odd", "carmen is odd"}));
  EXPECT_EQ(all.starts, (std::vector<std::size_t>{3, 5}));
  ASSERT_EQ(all.scans.size(), 9U);
  EXPECT_EQ(all.scans[4].timestamp_s, 1.0) << "times of different logs may collide";
  EXPECT_EQ(all.scans[5].timestamp_s, 50.0);
  const std::vector<std::size_t> expected{0, 0, 0, 1, 1, 2, 2, 2, 2};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(part_with(all, i), expected[i]) << i;
  EXPECT_EQ(sessions_of(all), expected);
  const std::vector<LogPart> parts = parts_of(all);
  ASSERT_EQ(parts.size(), 3U);
  EXPECT_EQ(parts[1].first, 3U);
  EXPECT_EQ(parts[1].last, 5U);
  EXPECT_EQ(parts[2].last, 9U);
}

TEST(JoinedLogs, OfOneLogIsThatLog) {
  const Log all = joined_logs({log_of(3, "nist", 7.0)});
  EXPECT_EQ(all.format, "nist");
  EXPECT_TRUE(all.starts.empty());
  ASSERT_EQ(parts_of(all).size(), 1U);
  EXPECT_EQ(parts_of(all)[0].last, 3U);
  EXPECT_EQ(part_with(all, 2), 0U);
  EXPECT_EQ(sessions_of(all), (std::vector<std::size_t>{0, 0, 0}));
}

TEST(JoinedLogs, AnEmptyLogKeepsItsNumber) {
  const Log all = joined_logs({log_of(2, "nist", 0.0), log_of(0, "nist", 0.0), log_of(1, "nist", 0.0)});
  ASSERT_EQ(parts_of(all).size(), 3U);
  EXPECT_EQ(parts_of(all)[1].first, parts_of(all)[1].last);
  EXPECT_EQ(part_with(all, 1), 0U);
  EXPECT_EQ(part_with(all, 2), 2U);
  EXPECT_EQ(sessions_of(all), (std::vector<std::size_t>{0, 0, 2}));
}

TEST(JoinedLogs, OfJoinedLogsKnowsAllBeginnings) {
  const Log two = joined_logs({log_of(2, "nist", 0.0), log_of(1, "nist", 0.0)});
  const Log all = joined_logs({two, two});
  EXPECT_EQ(all.starts, (std::vector<std::size_t>{2, 3, 5}));
}

}  // namespace
}  // namespace shapemap
