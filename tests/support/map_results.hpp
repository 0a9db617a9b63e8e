// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gmock/gmock.h>

#include <cmath>

#include "shapemap/mapper/map_result.hpp"
#include "support/matchers.hpp"

namespace shapemap::test {

inline void expect_same_bits(const ScanMatch& a, const ScanMatch& b) {
  EXPECT_EQ(a.status, b.status);
  EXPECT_THAT(a.ref_from_query, HasSameBits(b.ref_from_query));
  ASSERT_EQ(a.ranked.size(), b.ranked.size());
  for (std::size_t k = 0; k < a.ranked.size(); ++k) {
    EXPECT_THAT(a.ranked[k].ref_from_query, HasSameBits(b.ranked[k].ref_from_query));
    EXPECT_EQ(a.ranked[k].score, b.ranked[k].score);
  }
  EXPECT_TRUE(a.probability == b.probability || (std::isnan(a.probability) && std::isnan(b.probability)));
  EXPECT_TRUE(a.covariance == b.covariance || !b.covariance.allFinite());
}

/// All of a result but for the seconds that it took.
inline void expect_same_bits(const MapResult& a, const MapResult& b) {
  ASSERT_EQ(a.scans.size(), b.scans.size());
  for (std::size_t i = 0; i < a.scans.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_EQ(a.scans[i].scan_index, b.scans[i].scan_index);
    EXPECT_EQ(a.scans[i].session, b.scans[i].session);
    EXPECT_EQ(a.scans[i].component, b.scans[i].component);
    EXPECT_EQ(a.scans[i].starts_component, b.scans[i].starts_component);
    EXPECT_EQ(a.scans[i].reference, b.scans[i].reference);
    EXPECT_EQ(a.scans[i].loop_constrained, b.scans[i].loop_constrained);
    EXPECT_EQ(a.scans[i].is_keyframe, b.scans[i].is_keyframe);
    EXPECT_EQ(a.scans[i].reason, b.scans[i].reason);
    expect_same_bits(a.scans[i].match, b.scans[i].match);
  }
  ASSERT_EQ(a.components.size(), b.components.size());
  for (std::size_t k = 0; k < a.components.size(); ++k) {
    ASSERT_EQ(a.components[k].scans.size(), b.components[k].scans.size());
    for (std::size_t i = 0; i < a.components[k].scans.size(); ++i) {
      const PlacedScan& one = a.components[k].scans[i];
      const PlacedScan& other = b.components[k].scans[i];
      EXPECT_EQ(one.scan_index, other.scan_index);
      EXPECT_THAT(one.map_from_robot, HasSameBits(other.map_from_robot));
      ASSERT_EQ(one.robot_from_sweep.size(), other.robot_from_sweep.size());
      for (std::size_t s = 0; s < one.robot_from_sweep.size(); ++s) {
        EXPECT_THAT(one.robot_from_sweep[s], HasSameBits(other.robot_from_sweep[s]));
      }
    }
  }
  ASSERT_EQ(a.loops.size(), b.loops.size());
  for (std::size_t k = 0; k < a.loops.size(); ++k) {
    EXPECT_EQ(a.loops[k].a, b.loops[k].a);
    EXPECT_EQ(a.loops[k].b, b.loops[k].b);
    EXPECT_EQ(a.loops[k].strength, b.loops[k].strength);
  }
  EXPECT_EQ(a.largest_component, b.largest_component);
}

}  // namespace shapemap::test
