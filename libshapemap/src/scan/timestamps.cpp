// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/scan/timestamps.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <utility>

namespace shapemap {
namespace {

constexpr std::ptrdiff_t kMostPlacesSwapped = 3;

using Times = std::vector<double>;

Times times_of(const std::vector<Position>& positions) {
  Times times_s;
  times_s.reserve(positions.size());
  for (const Position& position : positions) times_s.push_back(position.timestamp_s);
  return times_s;
}

bool increases(const Times& times_s) {
  return std::adjacent_find(times_s.begin(), times_s.end(), std::greater_equal<>()) == times_s.end();
}

/// The middle one of the steps that go forward; a second where none does.
double usual_step_s(const Times& times_s) {
  Times steps_s;
  for (std::size_t i = 1; i < times_s.size(); ++i) {
    if (times_s[i] > times_s[i - 1]) steps_s.push_back(times_s[i] - times_s[i - 1]);
  }
  if (steps_s.empty()) return 1.0;
  const auto middle = steps_s.begin() + static_cast<std::ptrdiff_t>(steps_s.size() / 2);
  std::nth_element(steps_s.begin(), middle, steps_s.end());
  return *middle;
}

/// Sorts positions by time where none moves far; how many moved.
std::size_t sort_swapped(std::vector<Position>& positions, Times& times_s) {
  std::vector<std::size_t> order(times_s.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return times_s[a] < times_s[b]; });
  std::size_t num_moved = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (order[i] == i) continue;
    if (std::abs(static_cast<std::ptrdiff_t>(order[i]) - static_cast<std::ptrdiff_t>(i)) > kMostPlacesSwapped) return 0;
    ++num_moved;
  }
  if (num_moved == 0) return 0;
  std::vector<Position> sorted;
  sorted.reserve(positions.size());
  for (const std::size_t i : order) sorted.push_back(std::move(positions[i]));
  positions = std::move(sorted);
  times_s = times_of(positions);
  return num_moved;
}

std::size_t interpolate_single_ones(Times& times_s) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    const bool has_before = i > 0;
    const bool has_after = i + 1 < times_s.size();
    if (!has_before || !has_after || !(times_s[i - 1] < times_s[i + 1])) continue;
    if (times_s[i - 1] <= times_s[i] && times_s[i] <= times_s[i + 1]) continue;
    times_s[i] = 0.5 * (times_s[i - 1] + times_s[i + 1]);
    ++count;
  }
  return count;
}

/// The first time has none before it: one that lies after the second is wrong when the second and third go together.
std::size_t mend_first(Times& times_s, double step_s) {
  if (times_s.size() < 3 || times_s[0] <= times_s[1] || !(times_s[1] < times_s[2])) return 0;
  times_s[0] = times_s[1] - step_s;
  return 1;
}

std::size_t move_on_after_set_back(Times& times_s, double step_s) {
  std::size_t count = 0;
  double offset_s = 0.0;
  for (std::size_t i = 1; i < times_s.size(); ++i) {
    times_s[i] += offset_s;
    if (times_s[i] >= times_s[i - 1]) continue;
    const double more_s = times_s[i - 1] + step_s - times_s[i];
    offset_s += more_s;
    times_s[i] += more_s;
    ++count;
  }
  return count;
}

/// Times that repeat, or differ so little that rounding makes them do so, are spread up to the next.
std::size_t spread_repeated(Times& times_s, double step_s) {
  std::size_t count = 0;
  for (std::size_t first = 0; first < times_s.size();) {
    std::size_t next = first + 1;
    while (next < times_s.size() && times_s[next] <= times_s[first]) ++next;
    const double repeats = static_cast<double>(next - first);
    const double end_s = next < times_s.size() ? times_s[next] : times_s[first] + repeats * step_s;
    for (std::size_t i = first + 1; i < next; ++i) {
      times_s[i] = times_s[first] + (end_s - times_s[first]) * static_cast<double>(i - first) / repeats;
      ++count;
    }
    first = next;
  }
  return count;
}

}  // namespace

std::vector<std::string> TimestampRepairs::lines() const {
  std::vector<std::string> lines;
  const auto add = [&](std::size_t count, const char* what) {
    if (count > 0) lines.push_back(std::to_string(count) + " " + what);
  };
  if (all_replaced) lines.emplace_back("all timestamps are the same; the index of each position in seconds is taken");
  add(num_sorted, "positions were not in the order of their timestamps and are sorted");
  add(num_interpolated, "timestamps repeat or do not fit those around them, and are interpolated");
  add(num_set_back, "times the clock goes back; the order of the log stays, and its times go on by the usual step");
  return lines;
}

TimestampRepairs mend_timestamps(std::vector<Position>& positions) {
  TimestampRepairs repairs;
  Times times_s = times_of(positions);
  if (times_s.size() < 2 || increases(times_s)) return repairs;
  if (std::all_of(times_s.begin(), times_s.end(), [&](double time_s) { return time_s == times_s.front(); })) {
    repairs.all_replaced = true;
    std::iota(times_s.begin(), times_s.end(), 0.0);
  } else {
    const double step_s = usual_step_s(times_s);
    repairs.num_sorted = sort_swapped(positions, times_s);
    if (repairs.num_sorted == 0) {
      repairs.num_interpolated = mend_first(times_s, step_s) + interpolate_single_ones(times_s);
      repairs.num_set_back = move_on_after_set_back(times_s, step_s);
    }
    repairs.num_interpolated += spread_repeated(times_s, step_s);
  }
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i].timestamp_s = times_s[i];
  return repairs;
}

}  // namespace shapemap
