// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/io/pair_files.hpp"
#include "shapemap/scan/plausibility.hpp"
#include "text.hpp"

namespace shapemap {
namespace {

std::size_t index_from(std::string_view word, const char* name, std::size_t num_scans, const LineReader& lines) {
  const std::optional<long long> index = parse_count(word);
  if (!index || *index < 0 || static_cast<std::size_t>(*index) >= num_scans) {
    const std::string expected =
        num_scans == 0 ? "but the log has no positions" : "expected 0 to " + std::to_string(num_scans - 1);
    throw lines.error(std::string(name) + " is '" + std::string(word) + "', " + expected);
  }
  return static_cast<std::size_t>(*index);
}

}  // namespace

std::vector<ScanPair> read_pairs(const std::string& path, std::size_t num_references, std::size_t num_queries) {
  ByteSource source(path);
  LineReader lines(source);
  std::vector<ScanPair> pairs;
  while (const std::optional<std::string_view> line = lines.next()) {
    Words words(line->substr(0, line->find('#')));
    const std::size_t count = words.count_left();
    if (count == 0) continue;
    if (count != 2 && count != 5) {
      throw lines.error("expected 'i j' or 'i j x_m y_m theta_rad', found " + std::to_string(count) + " values");
    }
    ScanPair pair;
    pair.reference = index_from(words.next(), "the reference", num_references, lines);
    pair.query = index_from(words.next(), "the query", num_queries, lines);
    if (count == 5) {
      const double x_m = lines.finite(words.next(), "x_m");
      const double y_m = lines.finite(words.next(), "y_m");
      pair.given_ref_from_query = Pose2{x_m, y_m, wrap_angle(lines.finite(words.next(), "theta_rad"))};
      lines.refuse(implausibility(*pair.given_ref_from_query));
    }
    pairs.push_back(pair);
  }
  if (!source.cut().empty()) throw InputError(path + ": " + source.cut());
  if (pairs.empty()) throw InputError(path + ": names no pair, expected lines 'i j'");
  return pairs;
}

}  // namespace shapemap
