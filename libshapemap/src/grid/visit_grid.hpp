// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <unordered_map>

/// The grid counts how many visits ended in each cell of the plane, and how many passed through.
namespace shapemap {

struct VisitCell {
  std::uint32_t hits = 0;
  std::uint32_t passes = 0;
  std::uint32_t last_hit = 0;  ///< number of the last visit with a return here
  std::uint32_t last_pass = 0;

  void hit(std::uint32_t visit) {
    if (last_hit != visit) ++hits;
    last_hit = visit;
  }
  void pass(std::uint32_t visit) {
    if (last_pass != visit) ++passes;
    last_pass = visit;
  }
  /// Counts all visits but `visit`, which must be the last that was drawn.
  std::uint32_t other_hits(std::uint32_t visit) const { return hits - (last_hit == visit ? 1U : 0U); }
  std::uint32_t other_passes(std::uint32_t visit) const { return passes - (last_pass == visit ? 1U : 0U); }
};

/// An endless grid, in tiles that exist where something was seen.
class VisitGrid {
 public:
  VisitCell& at(const Eigen::Vector2i& cell) {
    const std::int64_t key = key_of(cell);
    if (key != last_key_) {
      std::unique_ptr<Tile>& tile = tiles_[key];
      if (!tile) tile = std::make_unique<Tile>();
      last_key_ = key;
      last_tile_ = tile.get();
    }
    return (*last_tile_)[index_of(cell)];
  }

  /// Returns an empty cell where there is no tile.
  const VisitCell& seen(const Eigen::Vector2i& cell) {
    static const VisitCell empty;
    const std::int64_t key = key_of(cell);
    if (key != last_key_) {
      const auto found = tiles_.find(key);
      if (found == tiles_.end()) return empty;
      last_key_ = key;
      last_tile_ = found->second.get();
    }
    return (*last_tile_)[index_of(cell)];
  }

 private:
  static constexpr int kSideBits = 5;
  static constexpr int kSide = 1 << kSideBits;
  using Tile = std::array<VisitCell, static_cast<std::size_t>(kSide) * kSide>;

  /// Shifts round towards minus infinity, so that tiles are alike on both sides of 0.
  static std::int64_t key_of(const Eigen::Vector2i& cell) {
    return (static_cast<std::int64_t>(cell.x() >> kSideBits) * (std::int64_t{1} << 32)) +
           static_cast<std::int64_t>(cell.y() >> kSideBits);
  }
  static std::size_t index_of(const Eigen::Vector2i& cell) {
    return static_cast<std::size_t>(((cell.y() & (kSide - 1)) << kSideBits) + (cell.x() & (kSide - 1)));
  }

  std::unordered_map<std::int64_t, std::unique_ptr<Tile>> tiles_;
  std::int64_t last_key_ = INT64_MIN;
  Tile* last_tile_ = nullptr;
};

}  // namespace shapemap
