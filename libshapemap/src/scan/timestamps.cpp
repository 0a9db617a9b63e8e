// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/scan/timestamps.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <numeric>
#include <optional>
#include <utility>

#include "shapemap/scan/returns.hpp"

namespace shapemap {
namespace {

/// Buffers swap neighbours, and busy computers stamp a few scans late; a larger disorder is a clock that was set.
constexpr std::ptrdiff_t kMostPlacesSwapped = 3;
constexpr std::size_t kMostLate = 10;

using Times = std::vector<double>;
using Order = std::vector<std::size_t>;

Times times_of(const std::vector<Scan>& scans) {
  Times times_s;
  times_s.reserve(scans.size());
  for (const Scan& scan : scans) times_s.push_back(scan.timestamp_s);
  return times_s;
}

bool increases(const Times& times_s) {
  return std::adjacent_find(times_s.begin(), times_s.end(), std::greater_equal<>()) == times_s.end();
}

/// Says whether more than half of the times are the same.
bool say_nothing(Times times_s) {
  const auto middle = times_s.begin() + static_cast<std::ptrdiff_t>(times_s.size() / 2);
  std::nth_element(times_s.begin(), middle, times_s.end());
  const double usual_s = *middle;
  return 2 * std::count(times_s.begin(), times_s.end(), usual_s) > static_cast<std::ptrdiff_t>(times_s.size());
}

/// Returns the median of the steps that go forward, or one second where none does.
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

/// Returns the order by time, unless a scan would move far.
std::optional<Order> order_by_time(const Times& times_s) {
  Order order(times_s.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return times_s[a] < times_s[b]; });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto places = static_cast<std::ptrdiff_t>(order[i]) - static_cast<std::ptrdiff_t>(i);
    if (std::abs(places) > kMostPlacesSwapped) return std::nullopt;
  }
  return order;
}

/// Returns how much two scans differ: the median difference of their readings. Beams without a return tell nothing.
double difference_m(const Scan& a, const Scan& b) {
  if (a.sweeps.empty() || b.sweeps.empty()) return 0.0;
  const std::vector<float>& of_a = a.sweeps.front().ranges_m;
  const std::vector<float>& of_b = b.sweeps.front().ranges_m;
  const RangeLimits limits_a = range_limits(a.sweeps.front(), {});
  const RangeLimits limits_b = range_limits(b.sweeps.front(), {});
  std::vector<double> differences_m;
  for (std::size_t i = 0; i < std::min(of_a.size(), of_b.size()); ++i) {
    if (!is_return(of_a[i], limits_a) || !is_return(of_b[i], limits_b)) continue;
    differences_m.push_back(std::abs(static_cast<double>(of_a[i]) - of_b[i]));
  }
  if (differences_m.empty()) return 0.0;
  const auto middle = differences_m.begin() + static_cast<std::ptrdiff_t>(differences_m.size() / 2);
  std::nth_element(differences_m.begin(), middle, differences_m.end());
  return *middle;
}

/// Says whether the scans change less from one to the next in `order` than in the order of the log. Where times were
/// stamped late, the order of the log is right; where scans were swapped, their times are.
bool is_smoother(const std::vector<Scan>& scans, const Order& order) {
  double as_ordered_m = 0.0;
  double as_recorded_m = 0.0;
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (order[i - 1] + 1 == order[i]) continue;
    as_ordered_m += difference_m(scans[order[i - 1]], scans[order[i]]);
  }
  std::vector<bool> follows(order.size(), false);
  for (std::size_t i = 1; i < order.size(); ++i) follows[order[i]] = order[i - 1] + 1 == order[i];
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (!follows[i]) as_recorded_m += difference_m(scans[i - 1], scans[i]);
  }
  return as_ordered_m < as_recorded_m;
}

/// Sorts scans by time where that is the order in which they were taken, and returns how many moved.
std::size_t sort_swapped(std::vector<Scan>& scans, Times& times_s) {
  const std::optional<Order> order = order_by_time(times_s);
  if (!order || !is_smoother(scans, *order)) return 0;
  std::size_t num_moved = 0;
  std::vector<Scan> sorted;
  sorted.reserve(scans.size());
  for (std::size_t i = 0; i < order->size(); ++i) {
    if ((*order)[i] != i) ++num_moved;
    sorted.push_back(std::move(scans[(*order)[i]]));
  }
  scans = std::move(sorted);
  times_s = times_of(scans);
  return num_moved;
}

/// Says for each time whether it belongs to the longest sequence that does not go back.
std::vector<bool> in_longest_sequence(const Times& times_s) {
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  Order ends;  // for each length, the last element of the best sequence
  Order before(times_s.size(), kNone);
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    const auto later = std::upper_bound(ends.begin(), ends.end(), times_s[i],
                                        [&](double time_s, std::size_t end) { return time_s < times_s[end]; });
    if (later != ends.begin()) before[i] = *std::prev(later);
    if (later == ends.end()) {
      ends.push_back(i);
    } else {
      *later = i;
    }
  }
  std::vector<bool> is_in(times_s.size(), false);
  for (std::size_t i = ends.empty() ? kNone : ends.back(); i != kNone; i = before[i]) is_in[i] = true;
  return is_in;
}

/// Puts a few times that do not fit into the sequence of the others between their neighbours, and returns how many.
std::size_t interpolate_odd_ones(Times& times_s, double step_s) {
  const std::vector<bool> fits = in_longest_sequence(times_s);
  std::size_t count = 0;
  for (std::size_t first = 0; first < times_s.size();) {
    if (fits[first]) {
      ++first;
      continue;
    }
    std::size_t next = first;
    while (next < times_s.size() && !fits[next]) ++next;
    if (next - first <= kMostLate) {
      const auto steps = static_cast<double>(next - first + 1);
      const double begin_s = first > 0 ? times_s[first - 1] : times_s[next] - steps * step_s;
      const double end_s = next < times_s.size() ? times_s[next] : begin_s + steps * step_s;
      for (std::size_t i = first; i < next; ++i, ++count) {
        times_s[i] = begin_s + (end_s - begin_s) * static_cast<double>(i - first + 1) / steps;
      }
    }
    first = next;
  }
  return count;
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

/// Spreads times that repeat, or differ so little that rounding makes them do so, up to the next time.
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
  if (all_replaced) lines.emplace_back("most timestamps are the same; the index of each position in seconds is taken");
  add(num_sorted, "positions were not in the order in which they were taken, and are sorted by their timestamps");
  add(num_interpolated, "timestamps repeat or do not fit those around them, and are interpolated");
  add(num_set_back, "times the clock goes back; the order of the log stays, and its times go on by the usual step");
  return lines;
}

TimestampRepairs mend_timestamps(std::vector<Scan>& scans) {
  TimestampRepairs repairs;
  Times times_s = times_of(scans);
  if (times_s.size() < 2 || increases(times_s)) return repairs;
  if (say_nothing(times_s)) {
    repairs.all_replaced = true;
    std::iota(times_s.begin(), times_s.end(), 0.0);
  } else {
    const double step_s = usual_step_s(times_s);
    repairs.num_sorted = sort_swapped(scans, times_s);
    if (repairs.num_sorted == 0) {
      repairs.num_interpolated = interpolate_odd_ones(times_s, step_s);
      repairs.num_set_back = move_on_after_set_back(times_s, step_s);
    }
    repairs.num_interpolated += spread_repeated(times_s, step_s);
  }
  for (std::size_t i = 0; i < scans.size(); ++i) scans[i].timestamp_s = times_s[i];
  return repairs;
}

}  // namespace shapemap
