// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/io/log_selection.hpp"

#include <gtest/gtest.h>

#include "shapemap/core/errors.hpp"

namespace shapemap {
namespace {

std::vector<double> selected(int first, int skip, int every) {
  Log log;
  for (int i = 0; i < 10; ++i) log.scans.push_back({static_cast<double>(i), {}, {}, {}});
  SelectionOptions options{first, skip, every};
  std::vector<double> left;
  for (const Scan& scan : select_scans(log, options).scans) left.push_back(scan.timestamp_s);
  for (std::size_t i = 0; i < left.size(); ++i) {
    EXPECT_EQ(static_cast<double>(index_in_whole_log(i, options)), left[i]);
  }
  return left;
}

TEST(LogSelection, SkipsThenTakesEveryNthThenTheFirstOfThose) {
  EXPECT_EQ(selected(0, 0, 1).size(), 10U);
  EXPECT_EQ(selected(3, 2, 3), (std::vector<double>{2, 5, 8}));
  EXPECT_EQ(selected(2, 2, 3), (std::vector<double>{2, 5}));
  EXPECT_EQ(selected(0, 9, 2147483647), (std::vector<double>{9}));
}

TEST(LogSelection, SaysSoWhenNothingIsLeft) {
  EXPECT_THROW(selected(0, 10, 1), ConfigError);
  EXPECT_THROW(selected(0, 0, 0), ConfigError);
}

}  // namespace
}  // namespace shapemap
