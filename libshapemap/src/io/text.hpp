// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "byte_source.hpp"
#include "shapemap/core/errors.hpp"
#include "shapemap/scan/scan.hpp"

/// Lines, words and numbers are the same in every locale.
namespace shapemap {

/// Reads the lines of a text with Unix or DOS line ends. The last line of a cut gzip stream is not returned.
class LineReader {
 public:
  explicit LineReader(ByteSource& source) : source_(source) {}
  /// Returns the next line, valid until the next call, or nothing at the end. Throws InputError on a line over 64 MiB.
  std::optional<std::string_view> next();
  /// Returns an error in the latest line: "path:line: what".
  InputError error(const std::string& what) const;
  std::string where() const;
  /// Throws InputError when a sweep that ends in the latest line is impossible, or one too many.
  void require_plausible(const Sweep& sweep);
  /// Throws InputError unless `fault`, see scan/plausibility.hpp, is empty.
  void refuse(const std::string& fault) const;
  /// Returns the number in `word` of the latest line. Throws InputError, which names `name`, when it is none or not
  /// finite.
  double finite(std::string_view word, const char* name) const;

 private:
  ByteSource& source_;
  std::size_t line_number_ = 0;
  std::size_t num_scans_ = 0;
  std::size_t pending_ = 0;  ///< bytes of the latest line, still in the window
};

/// Splits a line into words, separated by blanks and, if asked for, by another character.
class Words {
 public:
  explicit Words(std::string_view text, char also_separates = ' ') : rest_(text), separator_(also_separates) {}
  /// Returns the next word; empty at the end.
  std::string_view next();
  /// Steps over up to `count` words, and returns how many there were.
  std::size_t skip(std::size_t count);
  std::size_t count_left() const;

 private:
  bool separates(char c) const;

  std::string_view rest_;
  char separator_;
};

/// Returns the number that is the whole of `word`. A number too large to hold is infinite; `nan` and `inf` are numbers.
std::optional<double> parse_number(std::string_view word);
std::optional<long long> parse_count(std::string_view word);

/// Parses a reading of a text log, or returns nothing when the word is no reading at all. `-`, nan and inf are no
/// returns and become NaN; a negative reading says nothing and becomes 0.
std::optional<float> parse_range(std::string_view word, double metres_per_unit);

/// Appends the shortest decimal text that reads back as the same value.
template <class Number>
void append_number(std::string& text, Number value) {
  char buffer[64];
  const std::to_chars_result end = std::to_chars(buffer, buffer + sizeof buffer, value);
  text.append(buffer, end.ptr);
}

}  // namespace shapemap
