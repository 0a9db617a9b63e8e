// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/scan/timestamps.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace shapemap {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Makes scans that were taken at `taken_s`, with one reading that grows with time, and that are stamped with
/// `times_s`.
std::vector<Scan> at_times(const std::vector<double>& times_s, const std::vector<double>& taken_s) {
  std::vector<Scan> scans;
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    Scan scan;
    scan.timestamp_s = times_s[i];
    scan.sweeps.emplace_back();
    scan.sweeps.back().start_s = times_s[i];
    scan.sweeps.back().ranges_m = {static_cast<float>(taken_s[i])};
    scans.push_back(std::move(scan));
  }
  return scans;
}

std::vector<Scan> at_times(const std::vector<double>& times_s) { return at_times(times_s, times_s); }

/// Returns so many times, one second apart.
std::vector<double> steady(std::size_t count) {
  std::vector<double> times_s;
  for (std::size_t i = 0; i < count; ++i) times_s.push_back(static_cast<double>(i));
  return times_s;
}

std::vector<double> times_of(const std::vector<Scan>& scans) {
  std::vector<double> times_s;
  for (const Scan& scan : scans) times_s.push_back(scan.timestamp_s);
  return times_s;
}

TEST(Timestamps, ThatIncreaseStayAsTheyAre) {
  std::vector<Scan> scans = at_times({-1.0, 0.0, 0.1, 100.0});
  EXPECT_THAT(mend_timestamps(scans).lines(), IsEmpty());
  EXPECT_THAT(times_of(scans), ElementsAre(-1.0, 0.0, 0.1, 100.0));
  std::vector<Scan> none;
  EXPECT_THAT(mend_timestamps(none).lines(), IsEmpty());
  std::vector<Scan> one = at_times({0.0});
  EXPECT_THAT(mend_timestamps(one).lines(), IsEmpty());
}

TEST(Timestamps, ThatSayNothingBecomeTheIndex) {
  std::vector<Scan> rounded = at_times({-1.0, 1e9, 1e9, 1e9, 1e9, 2e9});
  EXPECT_TRUE(mend_timestamps(rounded).all_replaced);
  EXPECT_EQ(times_of(rounded), steady(6));
  std::vector<Scan> scans = at_times({7.0, 7.0, 7.0});
  EXPECT_TRUE(mend_timestamps(scans).all_replaced);
  EXPECT_THAT(times_of(scans), ElementsAre(0.0, 1.0, 2.0));
}

TEST(Timestamps, ThatWereSwappedAreSorted) {
  std::vector<Scan> scans = at_times({0.0, 0.2, 0.1, 0.3, 0.6, 0.4, 0.5, 0.7});
  const TimestampRepairs repairs = mend_timestamps(scans);
  EXPECT_EQ(repairs.num_sorted, 5U);
  EXPECT_THAT(times_of(scans), ElementsAre(0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7));
  for (const Scan& scan : scans) EXPECT_EQ(scan.sweeps[0].start_s, scan.timestamp_s);
}

/// In real recordings the computer was busy, and stamped some scans too late.
TEST(Timestamps, ThatWereStampedLateDoNotChangeTheOrder) {
  std::vector<Scan> scans = at_times({0.0, 1.0, 4.5, 3.0, 4.0, 5.0, 6.0, 7.9, 7.0, 8.0}, steady(10));
  const TimestampRepairs repairs = mend_timestamps(scans);
  EXPECT_EQ(repairs.num_sorted, 0U);
  EXPECT_EQ(repairs.num_interpolated, 2U);
  EXPECT_EQ(repairs.num_set_back, 0U);
  EXPECT_THAT(times_of(scans), ElementsAre(0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 6.5, 7.0, 8.0));
}

TEST(Timestamps, ThatFitNowhereAreInterpolated) {
  std::vector<Scan> scans = at_times({10.0, 11.0, 0.0, 13.0, 14.0, 900.0, 16.0, 17.0, 18.0}, steady(9));
  const TimestampRepairs repairs = mend_timestamps(scans);
  EXPECT_EQ(repairs.num_interpolated, 2U);
  EXPECT_EQ(repairs.num_set_back, 0U);
  EXPECT_THAT(times_of(scans), ElementsAre(10.0, 11.0, 12.0, 13.0, 14.0, 15.0, 16.0, 17.0, 18.0));
  std::vector<Scan> first = at_times({900.0, 1.0, 2.0, 3.0, 4.0, 5.0}, steady(6));
  EXPECT_EQ(mend_timestamps(first).num_interpolated, 1U);
  EXPECT_EQ(first.front().timestamp_s, 0.0);
}

TEST(Timestamps, GoOnWhereAClockWasSetBack) {
  std::vector<Scan> scans = at_times(steady(40));
  for (std::size_t i = 25; i < 40; ++i) scans[i].timestamp_s -= 20.0;
  EXPECT_EQ(mend_timestamps(scans).num_set_back, 1U);
  EXPECT_EQ(times_of(scans), steady(40));
}

TEST(Timestamps, ThatRepeatAreSpread) {
  std::vector<Scan> scans = at_times({0.0, 1.0, 1.0, 1.0, 1.0, 2.0, 3.0, 3.0, 5.0});
  EXPECT_EQ(mend_timestamps(scans).num_interpolated, 4U);
  EXPECT_THAT(times_of(scans), ElementsAre(0.0, 1.0, 1.25, 1.5, 1.75, 2.0, 3.0, 4.0, 5.0));
}

/// Whatever the times, they increase afterwards, no scan is lost, and a second run finds nothing to mend.
TEST(Timestamps, IncreaseAfterwardsWhateverTheyWere) {
  std::mt19937 rng(5);
  for (int run = 0; run < 300; ++run) {
    std::uniform_int_distribution<int> value(0, 1 + run % 20);
    std::vector<double> times_s;
    for (int i = 0; i < 2 + run % 30; ++i) times_s.push_back(0.25 * value(rng) + (run % 3 == 0 ? i : 0));
    std::vector<Scan> scans = at_times(times_s);
    mend_timestamps(scans);
    std::vector<double> mended_s = times_of(scans);
    EXPECT_TRUE(std::adjacent_find(mended_s.begin(), mended_s.end(), std::greater_equal<>()) == mended_s.end())
        << testing::PrintToString(times_s) << " becomes " << testing::PrintToString(mended_s);
    std::vector<double> kept_s;
    for (const Scan& scan : scans) kept_s.push_back(scan.sweeps[0].start_s);
    std::sort(kept_s.begin(), kept_s.end());
    std::sort(times_s.begin(), times_s.end());
    EXPECT_EQ(kept_s, times_s);
    EXPECT_THAT(mend_timestamps(scans).lines(), IsEmpty());
  }
}

}  // namespace
}  // namespace shapemap
