// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/inference/edge_verification.hpp"
#include "shapemap/matching/match_search.hpp"
#include "shapemap/paper/paper_listener.hpp"
#include "shapemap/shape/shape.hpp"

/// How a caller sees what led to a map, while it is made: for figures and analyses. See io/trace_file.hpp for one that
/// writes it all to a file.
namespace shapemap {

/// What the robust method has to choose from between two positions.
struct TracedLink {
  std::size_t reference_index = 0;
  std::size_t query_index = 0;
  const std::vector<MatchCandidate>& candidates;
  std::size_t num_own = 0;         ///< so many, the first, are the best first; the rest is by way of scans further back
  double insufficient_view = 0.0;  ///< insufficient_view() of the two scans; 0 where a motion was expected
};

/// What it chose, looking at the whole log.
struct TracedChoice {
  std::size_t reference_index = 0;
  std::size_t query_index = 0;
  std::size_t candidate = 0;  ///< index into the hypotheses of the link, or of its revision where there is one
  double margin = 0.0;
};

/// How a link that was in doubt was judged by all scans of both sides: see verify_edges().
struct TracedRevision {
  std::size_t reference_index = 0;
  std::size_t query_index = 0;
  const std::vector<MatchCandidate>& candidates;      ///< those of the link, and then what was looked for since
  const std::vector<EdgeSupport>& support_by_others;  ///< of each hypothesis
  const std::vector<double>& parallel_support;        ///< of each hypothesis
  std::size_t in_map = 0;                             ///< the hypothesis that the map had until then
  std::size_t candidate = 0;                          ///< the best
  double probability = 0.0;                           ///< that it is right
};

/// Calls come from one thread; shapes and alignments come in the order of the log, and what is referred to is gone
/// afterwards. Looking on changes no result; what a sink throws ends the run. Positions are indices into the log.
/// The robust method shows shapes, too, and no alignments; the paper's method shows nothing else.
struct TraceSink : PaperListener {
  virtual void on_link(const TracedLink& /*link*/) {}
  /// In order, after all links.
  virtual void on_revision(const TracedRevision& /*revision*/) {}
  /// After all links and revisions.
  virtual void on_choice(const TracedChoice& /*choice*/) {}
};

}  // namespace shapemap
