// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/matching/match_cache.hpp"

#include <gmock/gmock.h>

#include <map>
#include <mutex>
#include <random>
#include <stdexcept>
#include <tuple>

#include "shapemap/mapper/map_log.hpp"
#include "support/matchers.hpp"
#include "support/views.hpp"

namespace shapemap {
namespace {

using test::HasSameBits;

/// A cache in memory that counts its calls.
struct CountingCache : MatchCache {
  using Key = std::tuple<std::size_t, std::size_t, SearchKind>;

  std::optional<std::vector<MatchCandidate>> find(const MatchKey& key) override {
    const std::lock_guard<std::mutex> lock(mutex);
    const auto found = known.find({key.reference, key.query, key.search});
    if (found == known.end()) return std::nullopt;
    ++num_found;
    return found->second;
  }
  void keep(const MatchKey& key, const std::vector<MatchCandidate>& candidates) override {
    const std::lock_guard<std::mutex> lock(mutex);
    if (known.size() >= limit) throw std::runtime_error("full");
    known[{key.reference, key.query, key.search}] = candidates;
    ++num_kept;
  }

  /// Removes the matches of which `is_lost` is true, by their number.
  template <class IsLost>
  void lose(IsLost&& is_lost) {
    std::size_t i = 0;
    for (auto it = known.begin(); it != known.end(); ++i) it = is_lost(i) ? known.erase(it) : std::next(it);
    num_found = 0;
    num_kept = 0;
  }

  std::mutex mutex;
  std::map<Key, std::vector<MatchCandidate>> known;
  std::size_t num_found = 0;
  std::size_t num_kept = 0;
  std::size_t limit = 1000000;
};

/// Two rounds through a room give loops and doubtful edges. A blind scan makes numbers of keyframes and scans differ.
Log two_rounds() {
  const test::World world = test::cluttered_room(2);
  std::mt19937 rng(7);
  Log log;
  for (std::size_t i = 0; i < 34; ++i) {
    const double angle_rad = 2 * kPi * static_cast<double>(i) / 16.0;
    const Pose2 pose{0.9 * std::cos(angle_rad), 0.8 * std::sin(angle_rad), wrap_angle(1.7 * angle_rad)};
    log.scans.push_back(i == 5 ? test::blind_scan() : test::scan_of(world, pose, test::half_circle(), rng));
    log.scans.back().timestamp_s = static_cast<double>(i);
  }
  return log;
}

MappingOptions doubtful() {
  MappingOptions options;
  options.robust.matcher.search.candidates.rotation_peaks = 3;
  options.robust.matcher.search.candidates.refined = 4;
  options.robust.matcher.search.voting.peaks = 6;
  options.robust.front_end.doubt_below = 1.0;
  options.robust.loop_detection.bridge_below = 1.0;
  options.robust.keyframes.step_m = 0.0;
  return options;
}

MapResult mapped(const Log& log, MatchCache* cache, int threads = 2) {
  MappingOptions options = doubtful();
  options.run.threads = threads;
  MappingEvents nobody;
  return map_log(log, options, nobody, cache);
}

void expect_same_bits(const MapResult& a, const MapResult& b) {
  ASSERT_EQ(a.components.size(), b.components.size());
  for (std::size_t f = 0; f < a.components.size(); ++f) {
    ASSERT_EQ(a.components[f].scans.size(), b.components[f].scans.size());
    for (std::size_t i = 0; i < a.components[f].scans.size(); ++i) {
      EXPECT_THAT(a.components[f].scans[i].map_from_robot, HasSameBits(b.components[f].scans[i].map_from_robot));
    }
  }
  ASSERT_EQ(a.loops.size(), b.loops.size());
  for (std::size_t i = 0; i < a.loops.size(); ++i) EXPECT_EQ(a.loops[i].strength, b.loops[i].strength);
}

TEST(MatchCache, ChangesNothingWhateverItKnows) {
  const Log log = two_rounds();
  const MapResult without = mapped(log, nullptr);
  CountingCache cache;
  expect_same_bits(mapped(log, &cache), without);
  ASSERT_GT(cache.num_kept, 100U);
  const auto all = cache.known;

  for (const int share : {2, 3}) {
    cache.known = all;
    cache.lose([&](std::size_t i) { return i % static_cast<std::size_t>(share) == 0; });
    expect_same_bits(mapped(log, &cache, share), without);
    EXPECT_GT(cache.num_found, 0U);
    EXPECT_GT(cache.num_kept, 0U);
    EXPECT_EQ(cache.known.size(), all.size());
  }
}

TEST(MatchCache, ThatKnowsAllLeavesNothingToSearch) {
  const Log log = two_rounds();
  CountingCache cache;
  mapped(log, &cache);
  cache.lose([](std::size_t) { return false; });
  mapped(log, &cache);
  EXPECT_EQ(cache.num_kept, 0U);
}

TEST(MatchCache, IsAskedByScan) {
  CountingCache cache;
  mapped(two_rounds(), &cache);
  using Key = CountingCache::Key;
  EXPECT_EQ(cache.known.count(Key{4, 6, SearchKind::kFull}), 1U);  // scan 5 is blind
  std::size_t of_last = 0;
  std::size_t multi_reference = 0;
  for (const auto& [key, unused] : cache.known) {
    const auto [reference, query, search] = key;
    EXPECT_LT(reference, query);
    EXPECT_NE(reference, 5U);
    EXPECT_NE(query, 5U);
    of_last += query == 33 && search == SearchKind::kLoop ? 1 : 0;
    multi_reference += search == SearchKind::kMultiReference ? 1 : 0;
  }
  EXPECT_GT(of_last, 2U);
  EXPECT_GT(multi_reference, 30U);
}

TEST(MatchCache, EndsTheRunWhenItCannotKeep) {
  for (const std::size_t limit : {5U, 90U}) {
    CountingCache cache;
    cache.limit = limit;
    EXPECT_THROW(mapped(two_rounds(), &cache), std::runtime_error) << limit;
  }
}

}  // namespace
}  // namespace shapemap
