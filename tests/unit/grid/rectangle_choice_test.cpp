// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/rectangle_choice.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace shapemap {
namespace {

constexpr Rectangle kScans{-3, 3, -2, 2};
constexpr double kSoftening = 8.0;

/// Returns the outline of a rectangle, each cell of which is a surface.
std::vector<KnownCell> outline(const Rectangle& of) {
  std::vector<KnownCell> cells;
  for (std::int64_t x = of.left; x <= of.right; ++x)
    cells.insert(cells.end(), {{{x, of.bottom}, 10}, {{x, of.top}, 10}});
  for (std::int64_t y = of.bottom; y <= of.top; ++y)
    cells.insert(cells.end(), {{{of.left, y}, 10}, {{of.right, y}, 10}});
  return cells;
}

std::optional<Rectangle> best(const std::vector<KnownCell>& cells) { return best_rectangle(cells, kScans, kSoftening); }

TEST(RectangleChoice, HoldsAllWhereAllIsWorthItsSize) {
  EXPECT_FALSE(best(outline({-20, 25, -10, 12})));
  EXPECT_FALSE(best({}));
  EXPECT_FALSE(best({{{0, 0}, 1}})) << "between the scans";
}

TEST(RectangleChoice, LeavesOutWhatIsFarAndLittleOnAllSidesAtOnce) {
  const Rectangle room{-20, 25, -10, 12};
  std::vector<KnownCell> cells = outline(room);
  for (const std::int64_t far : {std::int64_t{300}, std::int64_t{5000}}) {
    cells.insert(cells.end(), {{{far, 3}, 10}, {{-far, 1}, 10}, {{4, far}, 10}, {{-far, -far}, 1}});
  }
  const std::optional<Rectangle> found = best(cells);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->holds({room.left, room.bottom}));
  EXPECT_TRUE(found->holds({room.right, room.top}));
  EXPECT_LT(found->right, 300);
  EXPECT_GT(found->left, -300);
  EXPECT_LT(found->top, 300);
}

TEST(RectangleChoice, CutsNothingForASmallGain) {
  std::vector<KnownCell> cells = outline({-20, 20, -20, 20});
  cells.push_back({{50, 0}, 1});  // 41 + 30 columns, of which a core of 41 is worth its size
  EXPECT_FALSE(best(cells));
  cells.push_back({{100, 100}, 1});
  EXPECT_TRUE(best(cells));
}

TEST(RectangleChoice, KeepsTwiceTheCoreForTheRest) {
  std::vector<KnownCell> cells = outline({-20, 20, -20, 20});
  cells.insert(cells.end(), {{{50, 0}, 1}, {{-400, 0}, 1}});
  const std::optional<Rectangle> found = best(cells);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->holds({50, 0}));
  EXPECT_FALSE(found->holds({-400, 0}));
}

TEST(RectangleChoice, DoesNotDependOnTheOrderOfCells) {
  std::vector<KnownCell> cells = outline({-20, 25, -10, 12});
  cells.insert(cells.end(), {{{900, 3}, 1}, {{-700, 1}, 1}, {{40, 1}, 1}});
  const std::optional<Rectangle> found = best(cells);
  std::reverse(cells.begin(), cells.end());
  const std::optional<Rectangle> again = best(cells);
  ASSERT_TRUE(found && again);
  EXPECT_EQ(found->left, again->left);
  EXPECT_EQ(found->right, again->right);
  EXPECT_EQ(found->bottom, again->bottom);
  EXPECT_EQ(found->top, again->top);
}

TEST(RectangleChoice, ManyFarCellsAreAMapOfTheirOwnRight) {
  std::vector<KnownCell> cells = outline({-20, 25, -10, 12});
  const std::vector<KnownCell> other = outline({400, 440, -10, 12});
  cells.insert(cells.end(), other.begin(), other.end());
  EXPECT_FALSE(best(cells));
}

}  // namespace
}  // namespace shapemap
