// SPDX-License-Identifier: GPL-3.0-or-later
#include "text.hpp"

#include <cmath>
#include <limits>

#include "shapemap/core/printable.hpp"
#include "shapemap/scan/plausibility.hpp"

namespace shapemap {
namespace {

constexpr std::size_t kLongestLine = std::size_t{64} << 20U;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

template <class Number>
std::optional<Number> parse_whole(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  Number value{};
  const std::from_chars_result end = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end.ptr != word.data() + word.size() || word.empty()) return std::nullopt;
  if (end.ec == std::errc::result_out_of_range)
    return std::numeric_limits<Number>::has_infinity ? std::numeric_limits<Number>::infinity()
                                                     : std::numeric_limits<Number>::max();
  if (end.ec != std::errc{}) return std::nullopt;
  return value;
}

}  // namespace

std::optional<std::string_view> LineReader::next() {
  source_.consume(pending_);
  pending_ = 0;
  std::size_t searched = 0;
  std::size_t length = std::string_view::npos;
  while (true) {
    length = source_.buffered().find('\n', searched);
    if (length != std::string_view::npos) break;
    searched = source_.buffered().size();
    if (searched > kLongestLine) {
      ++line_number_;
      throw error("the line is longer than 64 MiB, expected a laser scan");
    }
    if (source_.ensure(searched + 1) == searched) break;
  }
  const bool ends_without_newline = length == std::string_view::npos;
  if (ends_without_newline) length = source_.buffered().size();
  if (ends_without_newline && (length == 0 || !source_.cut().empty())) return std::nullopt;

  ++line_number_;
  pending_ = length + (ends_without_newline ? 0 : 1);
  std::string_view line = source_.buffered().substr(0, length);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  if (line_number_ == 1 && line.substr(0, 3) == kByteOrderMark) line.remove_prefix(3);
  return line;
}

void LineReader::require_plausible(const Sweep& sweep) {
  refuse(implausibility(sweep));
  refuse(implausible_count(num_scans_++, "scans"));
}

void LineReader::refuse(const std::string& fault) const {
  if (!fault.empty()) throw error(fault);
}

double LineReader::finite(std::string_view word, const char* name) const {
  const std::optional<double> value = parse_number(word);
  if (!value || !std::isfinite(*value)) {
    throw error(std::string(name) + " is '" + std::string(word) + "', expected a number");
  }
  return *value;
}

std::string LineReader::where() const { return source_.path() + ":" + std::to_string(line_number_); }

InputError LineReader::error(const std::string& what) const { return InputError(where() + ": " + printable(what)); }

bool Words::separates(char c) const {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f' || c == separator_;
}

std::string_view Words::next() {
  std::size_t begin = 0;
  while (begin < rest_.size() && separates(rest_[begin])) ++begin;
  std::size_t end = begin;
  while (end < rest_.size() && !separates(rest_[end])) ++end;
  const std::string_view word = rest_.substr(begin, end - begin);
  rest_.remove_prefix(end);
  return word;
}

std::size_t Words::skip(std::size_t count) {
  std::size_t skipped = 0;
  while (skipped < count && !next().empty()) ++skipped;
  return skipped;
}

std::size_t Words::count_left() const {
  Words ahead = *this;
  return ahead.skip(std::numeric_limits<std::size_t>::max());
}

std::optional<double> parse_number(std::string_view word) { return parse_whole<double>(word); }

std::optional<long long> parse_count(std::string_view word) { return parse_whole<long long>(word); }

std::optional<float> parse_range(std::string_view word, double metres_per_unit) {
  constexpr float kNoReturn = std::numeric_limits<float>::quiet_NaN();
  if (word == "-") return kNoReturn;
  const std::optional<double> value = parse_number(word);
  if (!value) return std::nullopt;
  const double range_m = *value * metres_per_unit;
  if (range_m < 0.0) return 0.0F;  // such a range is too near, or an error code, but does not say that nothing was hit
  const bool is_distance = std::isfinite(range_m) && range_m <= std::numeric_limits<float>::max();
  return is_distance ? static_cast<float>(range_m) : kNoReturn;
}

}  // namespace shapemap
