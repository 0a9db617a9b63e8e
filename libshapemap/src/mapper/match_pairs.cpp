// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/mapper/match_pairs.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>

#include "shapemap/core/errors.hpp"
#include "shapemap/core/parallel_for.hpp"
#include "shapemap/matching/scan_matcher.hpp"
#include "shapemap/scan/plausibility.hpp"

namespace shapemap {
namespace {

/// Number of pairs that are worked on in parallel, after which the observer is asked. It changes no result.
constexpr std::size_t kBlock = 32;

/// Keeps each view of a log's scans from the first pair that needs it to the last.
class Views {
 public:
  explicit Views(const Log& log) : log_(log), views_(log.scans.size()), last_use_(log.scans.size(), 0) {}

  /// Notes that pair number `use` needs a view; the numbers must not fall from call to call. Throws ConfigError for an
  /// index beyond the log.
  void note_use(std::size_t index, std::size_t use) {
    if (index >= log_.scans.size()) {
      throw ConfigError("there is no position " + std::to_string(index) + " in a log of " +
                        std::to_string(log_.scans.size()));
    }
    last_use_[index] = use;
  }

  void make(std::vector<std::size_t> wanted, const MappingOptions& options) {
    std::sort(wanted.begin(), wanted.end());
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    parallel_for(wanted.size(), options.run.threads, [&](std::size_t i) {
      std::unique_ptr<const ScanView>& view = views_[wanted[i]];
      if (view) return;
      view = std::make_unique<ScanView>(view_of(log_.scans[wanted[i]], options.returns, options.polylines,
                                                options.shape, options.robust.matcher.view));
    });
  }

  /// Releases a view that no pair from number `next_use` on needs.
  void drop(std::size_t index, std::size_t next_use) {
    if (last_use_[index] < next_use) views_[index].reset();
  }

  const ScanView& operator[](std::size_t index) const { return *views_[index]; }

 private:
  const Log& log_;
  std::vector<std::unique_ptr<const ScanView>> views_;
  std::vector<std::size_t> last_use_;
};

bool has_shape(const ScanView& view, const char* which, const MappingOptions& options, ScanMatch& match) {
  if (view.size() >= static_cast<std::size_t>(options.shape.min_points)) return true;
  match.status = MatchStatus::kNoShape;
  match.reason = std::string("the ") + which + " has only " + std::to_string(view.size()) + " shape points, " +
                 std::to_string(options.shape.min_points) + " are needed";
  return false;
}

AlignedPair align_pair(const ScanPair& pair, const ScanView& reference, const ScanView& query,
                       const MappingOptions& options) {
  using Clock = std::chrono::steady_clock;
  AlignedPair result;
  result.pair = pair;
  if (!has_shape(reference, "reference", options, result.match)) return result;
  if (!has_shape(query, "query", options, result.match)) return result;
  const auto start = Clock::now();
  result.match = match_scans(reference, query, options.robust.matcher);
  result.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  if (const auto& given = pair.given_ref_from_query) {
    result.given = ranked_pose(candidate_at(reference, query, *given, options.robust.matcher.search));
    result.refined = ranked_pose(refined_candidate(reference, query, *given, options.robust.matcher.search));
  }
  return result;
}

}  // namespace

std::vector<ScanPair> pairs_with_gap(std::size_t num_scans, std::size_t gap) {
  std::vector<ScanPair> pairs;
  for (std::size_t i = 0; gap < num_scans && i < num_scans - gap; ++i) pairs.push_back({i, i + gap, {}});
  return pairs;
}

std::vector<AlignedPair> align_pairs(const Log& references, const Log& queries, const std::vector<ScanPair>& pairs,
                                     const MappingOptions& options, RunObserver& observer) {
  validate_all(options);
  require_plausible(references);
  if (&references != &queries) require_plausible(queries);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!pairs[i].given_ref_from_query) continue;
    const std::string fault = implausibility(*pairs[i].given_ref_from_query);
    if (!fault.empty()) throw InputError("the given pose of pair " + std::to_string(i) + ": " + fault);
  }
  Views of_references(references);
  Views of_other_log(queries);
  Views& of_queries = &references == &queries ? of_references : of_other_log;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    of_references.note_use(pairs[i].reference, i);
    of_queries.note_use(pairs[i].query, i);
  }
  std::vector<AlignedPair> results(pairs.size());
  for (std::size_t first = 0; first < pairs.size(); first += kBlock) {
    if (!observer.keep_going()) throw Interrupted();
    const std::size_t last = std::min(first + kBlock, pairs.size());
    std::vector<std::size_t> wanted_references;
    std::vector<std::size_t> wanted_queries;
    for (std::size_t i = first; i < last; ++i) {
      wanted_references.push_back(pairs[i].reference);
      wanted_queries.push_back(pairs[i].query);
    }
    of_references.make(std::move(wanted_references), options);
    of_queries.make(std::move(wanted_queries), options);
    parallel_for(last - first, options.run.threads, [&](std::size_t k) {
      const ScanPair& pair = pairs[first + k];
      results[first + k] = align_pair(pair, of_references[pair.reference], of_queries[pair.query], options);
    });
    for (std::size_t i = first; i < last; ++i) {
      of_references.drop(pairs[i].reference, last);
      of_queries.drop(pairs[i].query, last);
    }
    observer.on_progress(last, pairs.size());
  }
  return results;
}

}  // namespace shapemap
