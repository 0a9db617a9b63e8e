// SPDX-License-Identifier: GPL-3.0-or-later
#include "run_summary.hpp"

#include <algorithm>
#include <cstdio>

#include "console.hpp"

namespace shapemap::cli {
namespace {

std::string counted(std::size_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

/// Says whether a match with an earlier scan placed the scan; at the start of a session there is none.
bool is_placed_by_match(const ScanResult& scan) {
  return scan.component >= 0 && !scan.starts_component && !scan.is_without_shape();
}

/// Says whether a scan is in the map although its match is in doubt.
bool is_doubtful(const ScanResult& scan) { return is_placed_by_match(scan) && !scan.is_sure(); }

bool is_uncertain(const ScanResult& scan) { return is_doubtful(scan) && !scan.loop_constrained; }

std::vector<std::string> uncertain_lines(const LogSet& logs, const MapResult& result) {
  std::vector<std::string> lines;
  for (const ScanResult& scan : result.scans) {
    if (!is_uncertain(scan)) continue;
    lines.push_back(logs.scan_name(scan.scan_index) + " " + scan.status_text() + ": " + scan.alignment_reason());
  }
  return lines;
}

void print_uncertain(const MapResult& result) {
  std::size_t aligned = 0;
  std::size_t held = 0;
  std::size_t too_apart = 0;
  std::size_t ambiguous = 0;
  std::size_t degenerate = 0;
  for (const ScanResult& scan : result.scans) {
    if (is_placed_by_match(scan)) ++aligned;
    if (is_doubtful(scan) && scan.loop_constrained) ++held;
    if (!is_uncertain(scan)) continue;
    const MatchStatus status = scan.match.status;
    ++(status == MatchStatus::kAmbiguous ? ambiguous : status == MatchStatus::kDegenerate ? degenerate : too_apart);
  }
  const std::size_t uncertain = too_apart + ambiguous + degenerate;
  if (uncertain + held == 0) return;
  std::string text = std::to_string(uncertain) + " of " + counted(aligned, "alignment") + " are uncertain";
  if (uncertain > 0) {
    text += ": " + std::to_string(too_apart) + " with too little overlap, " + std::to_string(ambiguous) +
            " ambiguous, " + std::to_string(degenerate) + " degenerate";
  }
  if (held > 0) text += "; " + std::to_string(held) + " more would be, but loops hold these positions";
  print_line(text);
}

/// Returns "positions 3, 5, 8", or of several logs "a.log positions 3, 5; b.log positions 0".
std::string contradicting_text(const LogSet& logs, const std::vector<std::size_t>& indices) {
  std::string text;
  std::size_t last_log = logs.files.size();
  for (const std::size_t index : indices) {
    const std::size_t log = part_with(logs.log, index);
    if (log != last_log) {
      text += (text.empty() ? "" : "; ") + (logs.is_one() ? "" : logs.files.at(log).path + " ") + "positions ";
    } else {
      text += ", ";
    }
    last_log = log;
    text += std::to_string(index_in_whole_log(index - parts_of(logs.log).at(log).first, logs.selection));
  }
  return text;
}

void print_contradicting(const LogSet& logs, const MapResult& result, std::size_t max_listed) {
  std::vector<std::size_t> found;
  for (const PlacedScan& place : result.placed()) {
    if (place.consistency.contradicts_map) found.push_back(place.scan_index);
  }
  if (found.empty()) return;
  const std::size_t total = found.size();
  found.resize(std::min(total, max_listed));
  std::string text = counted(total, "scan") + (total == 1 ? " contradicts" : " contradict") +
                     " the rest of the map: " + contradicting_text(logs, found);
  if (total > found.size()) text += " and " + std::to_string(total - found.size()) + " more, see --report";
  print_line(text, std::string::npos);  // a long list is what was asked for
}

/// Returns "positions 3 to 8 of a.log, 0 to 4 of b.log".
std::string component_text(const LogSet& logs, const std::vector<PlacedScan>& scans) {
  std::string text;
  for (const LogPart& part : parts_of(logs.log)) {
    const std::vector<PlacedScan> own = placed_of(scans, part);
    if (own.empty()) continue;
    text += (text.empty() ? "" : "; ") + counted(own.size(), "position") + ", " +
            logs.scan_name(own.front().scan_index) + " to " + logs.scan_name(own.back().scan_index);
  }
  return text;
}

std::vector<std::string> component_lines(const LogSet& logs, const MapResult& result) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < result.components.size(); ++i) {
    if (static_cast<int>(i) == result.largest_component || result.components[i].scans.empty()) continue;
    lines.push_back("fragment " + std::to_string(i) +
                    " is apart from the map: " + component_text(logs, result.components[i].scans));
  }
  return lines;
}

/// Prints a line for each of several logs, so that a robot that is nowhere on the map is not overlooked.
void print_logs(const LogSet& logs, const MapResult& result) {
  if (logs.is_one()) return;
  const std::vector<LogPart> parts = parts_of(logs.log);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::size_t placed = placed_of(result.placed(), parts[i]).size();
    const std::string total = counted(parts[i].last - parts[i].first, "position");
    print_line(logs.files.at(i).path + ": " +
               (placed == 0 ? "nothing ties it to the map, none of " + total + " placed"
                            : "placed " + std::to_string(placed) + " of " + total));
  }
}

void print_outside(const std::vector<DrawnComponent>& drawn) {
  std::size_t outside = 0;
  std::size_t returns = 0;
  std::size_t pictures = 0;
  for (const DrawnComponent& component : drawn) {
    if (&component != &drawn.front() && component.num_outside > 0) {
      outside += component.num_outside;
      returns += component.num_returns;
      ++pictures;
    }
  }
  const auto text = [](std::size_t some, std::size_t all, const std::string& of_what) {
    return std::to_string(some) + " of " + counted(all, "return") + (some == 1 ? " lies" : " lie") + " outside of " +
           of_what + "; --draw-all draws them";
  };
  if (!drawn.empty() && drawn.front().num_outside > 0) {
    print_line(text(drawn.front().num_outside, drawn.front().num_returns, "the picture"));
  }
  if (outside > 0) print_line(text(outside, returns, counted(pictures, "fragment") + "' pictures"));
}

void print_walls(const MapNotes& notes, const MapResult& result) {
  if (notes.walls.empty() || result.largest_component < 0) return;
  const WallDirection& walls = notes.walls.at(static_cast<std::size_t>(result.largest_component));
  char text[200];
  if (walls.is_dominant()) {
    std::snprintf(text, sizeof text, "turned by %.2f degrees, so that %.0f %% of the walls are straight",
                  walls.turn_rad() / kDegree, 100.0 * walls.share);
  } else {
    std::snprintf(text, sizeof text,
                  "not turned: no direction of walls dominates (the best has %.0f %% of them, another %.0f %%)",
                  100.0 * walls.share, 100.0 * walls.second_share);
  }
  print_line(text);
}

void print_details(const LogSet& logs, const RunCosts& costs, const StageTimes& times) {
  const std::vector<LogPart> parts = parts_of(logs.log);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!logs.is_one()) std::fprintf(stderr, "log         %s\n", printable(logs.files.at(i).path).c_str());
    LogSummary summary = summarise(logs.log, parts[i].first, parts[i].last);
    summary.format = logs.files.at(i).format;
    std::fputs(log_summary_text(summary).c_str(), stderr);
  }
  std::fprintf(stderr,
               "seconds     read %.2f, map %.2f (shapes %.2f, alignment %.2f, ICP %.2f, decoupled ICP %.2f, loops "
               "%.2f, agreement %.2f), "
               "write %.2f\n"
               "memory      %.0f MiB\n",
               costs.read_s, costs.map_s, times.shape_s, times.align_s, times.icp_s, times.decoupled_icp_s,
               times.loops_s, times.consistency_s, costs.write_s, costs.peak_memory_mib);
}

std::string result_text(const MapArguments& arguments, const MapResult& result, double wall_s) {
  const auto keyframes = std::count_if(result.scans.begin(), result.scans.end(),
                                       [](const auto& scan) { return scan.component >= 0 && scan.is_keyframe; });
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, "%.1f s", wall_s);
  return "placed " + std::to_string(result.placed().size()) + " of " + counted(result.scans.size(), "position") + " (" +
         counted(static_cast<std::size_t>(keyframes), "keyframe") + ", " + counted(result.loops.size(), "loop") + ", " +
         counted(result.components.size(), "fragment") + ") in " + seconds + "; map: " + arguments.map_path;
}

}  // namespace

std::vector<std::string> unplaced_lines(const LogSet& logs, const MapResult& result) {
  std::vector<std::string> lines;
  for (const ScanResult& scan : result.scans) {
    const std::string why = result.why_not_in_map(scan);
    if (!why.empty()) lines.push_back(logs.scan_name(scan.scan_index) + " not placed: " + why);
  }
  return lines;
}

void print_sweeps(const MapArguments& arguments, const LogSet& logs, const std::vector<SweepVerdict>& sweeps) {
  if (arguments.verbosity == Verbosity::kQuiet) return;
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    if (sweeps[i].text.empty()) continue;
    print_line((logs.is_one() ? "" : logs.files.at(i).path + ": ") + sweeps[i].text);
  }
}

void print_interrupted(const LogSet& logs, const MapResult& result) {
  const std::size_t total = logs.log.scans.size();
  const std::string where = result.scans.size() < total
                                ? "after " + std::to_string(result.scans.size()) + " of " + counted(total, "position")
                                : "before all loops were looked for";
  print_line("interrupted " + where + "; writing the map so far (once more: leave at once, with nothing written)");
}

void print_summary(const MapArguments& arguments, const LogSet& logs, const RunOutcome& outcome) {
  const auto& [result, notes, warnings, costs] = outcome;
  if (arguments.verbosity == Verbosity::kQuiet) return;
  const bool verbose = arguments.verbosity == Verbosity::kVerbose;
  const std::size_t max_listed = verbose ? static_cast<std::size_t>(-1) : kMaxListed;
  print_lines("warning: ", warnings, max_listed);
  print_lines("", unplaced_lines(logs, result), max_listed);
  print_lines("", uncertain_lines(logs, result), max_listed);
  if (verbose) print_lines("", component_lines(logs, result), max_listed);
  if (verbose) print_details(logs, costs, result.times);
  print_uncertain(result);
  print_contradicting(logs, result, max_listed);
  print_logs(logs, result);
  print_walls(notes, result);
  print_outside(notes.drawn);
  print_line(result_text(arguments, result, costs.wall_s));
}

}  // namespace shapemap::cli
