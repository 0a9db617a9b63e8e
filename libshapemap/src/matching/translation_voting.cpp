// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/matching/translation_voting.hpp"
#include "matching_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace shapemap {
namespace {

double in_turn(double angle_rad) { return angle_rad - 2.0 * kPi * std::floor(angle_rad / (2.0 * kPi)); }

}  // namespace

double max_shift_m(const ScanView& reference, const ScanView& query, const VotingOptions& options) {
  if (options.max_shift_m > 0.0) return options.max_shift_m;
  const VotingNumbers& numbers = kMatching.voting;
  return std::clamp(numbers.shift_by_reach * std::max(reference.reach_m, query.reach_m), numbers.least_shift_m,
                    numbers.most_shift_m);
}

TranslationVoting::TranslationVoting(const ScanView& reference, double max_shift_m, const VotingOptions& options)
    : reference_(reference),
      options_(options),
      max_shift_m_(max_shift_m),
      width_(2 * static_cast<std::size_t>(std::ceil(max_shift_m / options.cell_m)) + 3),
      order_(reference.size()) {
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  const auto tangent = [&](std::size_t i) { return in_turn(reference.points[i].tangent_rad); };
  std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) { return tangent(a) < tangent(b); });
  for (const std::size_t i : order_) tangents_rad_.push_back(tangent(i));
}

std::vector<Point2> TranslationVoting::peaks(const ScanView& query, double rotation_rad, int max_count) const {
  const Votes votes = blurred(cast(query, rotation_rad));
  const auto count = static_cast<std::size_t>(max_count);
  // Cells beside a better one are passed over, so more cells than peaks are needed.
  std::vector<std::size_t> cells;
  for (std::size_t row = 1; row + 1 < width_; ++row) {
    for (std::size_t cell = row * width_ + 1; cell + 1 < (row + 1) * width_; ++cell) {
      if (votes[cell] > 0.0F) cells.push_back(cell);
    }
  }
  const auto more_votes = [&](std::size_t a, std::size_t b) {
    return votes[a] > votes[b] || (votes[a] == votes[b] && a < b);
  };
  const std::size_t num_sorted = std::min(cells.size(), kMatching.voting.cells_per_peak * count);
  std::partial_sort(cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(num_sorted), cells.end(), more_votes);
  cells.resize(num_sorted);

  std::vector<Point2> shifts_m;
  std::vector<char> taken(votes.size(), 0);
  const double middle = 0.5 * static_cast<double>(width_ - 1);
  for (const std::size_t cell : cells) {
    if (taken[cell]) continue;
    if (shifts_m.size() == count) break;
    for (const std::size_t near : {cell - width_, cell, cell + width_})
      taken[near - 1] = taken[near] = taken[near + 1] = 1;
    const std::size_t column = cell % width_;
    const std::size_t row = cell / width_;
    shifts_m.emplace_back((static_cast<double>(column) - middle) * options_.cell_m,
                          (static_cast<double>(row) - middle) * options_.cell_m);
  }
  return shifts_m;
}

TranslationVoting::Votes TranslationVoting::cast(const ScanView& query, double rotation_rad) const {
  Votes votes(width_ * width_, 0.0F);
  const Turn turn(rotation_rad);
  const double tolerance_rad = options_.tangent_tolerance_rad;
  for (std::size_t q = 0; q < query.size(); ++q) {
    const Point2 turned_m = turn * query.points[q].p_m;
    const double tangent_rad = in_turn(query.points[q].tangent_rad + rotation_rad);
    const double from_rad = tangent_rad - tolerance_rad;
    const double to_rad = tangent_rad + tolerance_rad;
    cast_from(turned_m, query.weights[q], from_rad, to_rad, votes);
    if (from_rad < 0.0) cast_from(turned_m, query.weights[q], from_rad + 2.0 * kPi, 2.0 * kPi, votes);
    if (to_rad > 2.0 * kPi) cast_from(turned_m, query.weights[q], 0.0, to_rad - 2.0 * kPi, votes);
  }
  return votes;
}

void TranslationVoting::cast_from(const Point2& turned_m, double weight, double from_rad, double to_rad,
                                  Votes& votes) const {
  const double per_m = 1.0 / options_.cell_m;
  const double middle = 0.5 * static_cast<double>(width_);
  const auto first = std::lower_bound(tangents_rad_.begin(), tangents_rad_.end(), from_rad) - tangents_rad_.begin();
  for (auto k = static_cast<std::size_t>(first); k < order_.size() && tangents_rad_[k] <= to_rad; ++k) {
    const Point2 shift_m = reference_.points[order_[k]].p_m - turned_m;
    if (std::abs(shift_m.x()) > max_shift_m_ || std::abs(shift_m.y()) > max_shift_m_) continue;
    const auto column = static_cast<std::size_t>(shift_m.x() * per_m + middle);
    const auto row = static_cast<std::size_t>(shift_m.y() * per_m + middle);
    votes[row * width_ + column] += static_cast<float>(weight * reference_.weights[order_[k]]);
  }
}

/// Spreads votes over the cells beside theirs, since a peak may lie near the edge of a cell.
TranslationVoting::Votes TranslationVoting::blurred(const Votes& votes) const {
  Votes rows(votes.size(), 0.0F);
  for (std::size_t i = 1; i + 1 < votes.size(); ++i) rows[i] = votes[i - 1] + 2.0F * votes[i] + votes[i + 1];
  Votes sums(votes.size(), 0.0F);
  for (std::size_t i = width_; i + width_ < votes.size(); ++i)
    sums[i] = rows[i - width_] + 2.0F * rows[i] + rows[i + width_];
  return sums;
}

}  // namespace shapemap
