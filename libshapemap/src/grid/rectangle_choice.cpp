// SPDX-License-Identifier: GPL-3.0-or-later
#include "rectangle_choice.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace shapemap {
namespace {

constexpr double kSharePerGrowth = 0.03;  // as a share of the known cells, for a picture that is e times larger
constexpr double kWhole = 4.0;            // the picture holds all where that makes it no larger than so many cores
constexpr double kSlack = 2.0;            // otherwise it holds as much as fits into so many cores
constexpr double kLineGrowth = 1.25;      // growth of the distances from the scans at which the picture may end

/// Limits are whole cells, so that near lines are one cell apart.
std::int64_t next_limit(std::int64_t limit) {
  return std::max(limit + 1, static_cast<std::int64_t>(std::ceil(kLineGrowth * static_cast<double>(limit))));
}

/// The lines at which the picture may end on one side: distances from the scans, in cells, ascending. Each is that of
/// the farthest cell with returns before the next; the first is 0.
class Side {
 public:
  void add(std::int64_t distance) {
    if (distance > 0) distances_.push_back(distance);
  }
  void finish() {
    std::sort(distances_.begin(), distances_.end());
    std::int64_t limit = 1;
    for (const std::int64_t distance : distances_) {
      const bool is_new = distance > limit || lines_.size() == 1;
      while (distance > limit) limit = next_limit(limit);
      if (is_new) lines_.push_back(distance);
      lines_.back() = distance;
    }
    distances_ = {};
  }
  std::int64_t count() const { return static_cast<std::int64_t>(lines_.size()); }
  std::int64_t distance(std::int64_t line) const { return lines_[static_cast<std::size_t>(line)]; }
  /// Returns the first line that holds a cell at this distance.
  std::int64_t line_for(std::int64_t distance) const {
    return std::lower_bound(lines_.begin(), lines_.end(), distance) - lines_.begin();
  }

 private:
  std::vector<std::int64_t> distances_;
  std::vector<std::int64_t> lines_{0};
};

/// Chooses among all rectangles that hold the scans and end at lines of the four sides.
class RectangleChoice {
 public:
  RectangleChoice(const std::vector<KnownCell>& cells, const Rectangle& scans, double softening_cells)
      : scans_(scans), softening_cells_(softening_cells) {
    for (const auto& [cell, worth] : cells) {
      left_.add(scans_.left - cell.x);
      right_.add(cell.x - scans_.right);
      bottom_.add(scans_.bottom - cell.y);
      top_.add(cell.y - scans_.top);
    }
    for (Side* side : {&left_, &right_, &bottom_, &top_}) side->finish();
    sum_up(cells);
  }

  /// Returns the best rectangle in cells, or nothing where the picture is to hold all.
  std::optional<Rectangle> best() const {
    const std::int64_t all = worth_inside(whole());
    double most = -std::numeric_limits<double>::infinity();
    Rectangle core;
    for_each_rectangle({}, [&](const Rectangle& lines) {
      const double merit =
          static_cast<double>(worth_inside(lines)) / static_cast<double>(all) - kSharePerGrowth * std::log(area(lines));
      if (merit <= most) return;
      most = merit;
      core = lines;
    });
    if (area(whole()) <= kWhole * area(core)) return std::nullopt;
    const double room = kSlack * area(core);
    Rectangle chosen = core;
    for_each_rectangle(core, [&](const Rectangle& lines) {
      if (area(lines) > room) return;
      const std::int64_t more = worth_inside(lines) - worth_inside(chosen);
      if (more > 0 || (more == 0 && area(lines) < area(chosen))) chosen = lines;
    });
    return Rectangle{scans_.left - left_.distance(chosen.left), scans_.right + right_.distance(chosen.right),
                     scans_.bottom - bottom_.distance(chosen.bottom), scans_.top + top_.distance(chosen.top)};
  }

 private:
  Rectangle whole() const { return {left_.count() - 1, right_.count() - 1, bottom_.count() - 1, top_.count() - 1}; }

  /// Visits all rectangles that hold at least the lines of `least`.
  template <class Visit>
  void for_each_rectangle(const Rectangle& least, const Visit& visit) const {
    const Rectangle last = whole();
    Rectangle lines;
    for (lines.left = least.left; lines.left <= last.left; ++lines.left) {
      for (lines.right = least.right; lines.right <= last.right; ++lines.right) {
        for (lines.bottom = least.bottom; lines.bottom <= last.bottom; ++lines.bottom) {
          for (lines.top = least.top; lines.top <= last.top; ++lines.top) visit(lines);
        }
      }
    }
  }

  double area(const Rectangle& lines) const {
    const std::int64_t width = scans_.right - scans_.left + left_.distance(lines.left) + right_.distance(lines.right);
    const std::int64_t height = scans_.top - scans_.bottom + bottom_.distance(lines.bottom) + top_.distance(lines.top);
    return (static_cast<double>(width) + softening_cells_) * (static_cast<double>(height) + softening_cells_);
  }

  /// Computes the sum from the four corners of the table of sums.
  std::int64_t worth_inside(const Rectangle& lines) const {
    const std::int64_t first_column = left_.count() - 1 - lines.left;
    const std::int64_t last_column = left_.count() + lines.right;
    const std::int64_t first_row = bottom_.count() - 1 - lines.bottom;
    const std::int64_t last_row = bottom_.count() + lines.top;
    return sum_at(last_column, last_row) - sum_at(first_column, last_row) - sum_at(last_column, first_row) +
           sum_at(first_column, first_row);
  }

  std::size_t index_of(std::int64_t column, std::int64_t row) const {
    return static_cast<std::size_t>(row * (left_.count() + right_.count()) + column);
  }
  std::int64_t sum_at(std::int64_t column, std::int64_t row) const { return sums_[index_of(column, row)]; }

  /// Column 0 and row 0 are empty; the scans are in column left_.count() and row bottom_.count().
  void sum_up(const std::vector<KnownCell>& cells) {
    const std::int64_t num_columns = left_.count() + right_.count();
    const std::int64_t num_rows = bottom_.count() + top_.count();
    sums_.assign(static_cast<std::size_t>(num_columns * num_rows), 0);
    for (const auto& [cell, worth] : cells) {
      const std::int64_t column = left_.count() + right_.line_for(std::max<std::int64_t>(0, cell.x - scans_.right)) -
                                  left_.line_for(std::max<std::int64_t>(0, scans_.left - cell.x));
      const std::int64_t row = bottom_.count() + top_.line_for(std::max<std::int64_t>(0, cell.y - scans_.top)) -
                               bottom_.line_for(std::max<std::int64_t>(0, scans_.bottom - cell.y));
      sums_[index_of(column, row)] += worth;
    }
    for (std::int64_t row = 1; row < num_rows; ++row) {
      for (std::int64_t column = 1; column < num_columns; ++column) {
        sums_[index_of(column, row)] += sum_at(column - 1, row) + sum_at(column, row - 1) - sum_at(column - 1, row - 1);
      }
    }
  }

  Rectangle scans_;
  double softening_cells_;
  Side left_;
  Side right_;
  Side bottom_;
  Side top_;
  std::vector<std::int64_t> sums_;
};

}  // namespace

std::optional<Rectangle> best_rectangle(const std::vector<KnownCell>& cells, const Rectangle& scans,
                                        double softening_cells) {
  return RectangleChoice(cells, scans, softening_cells).best();
}

}  // namespace shapemap
