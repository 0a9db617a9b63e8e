// SPDX-License-Identifier: GPL-3.0-or-later
#include "console.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "run_program.hpp"
#include "shapemap/core/angles.hpp"
#include "shapemap/core/errors.hpp"

namespace shapemap::cli {
namespace {

/// Returns a text such as "360" or "340 to 380, unevenly spaced,".
std::string beams_text(const LogSummary::Sensor& sensor) {
  std::string text = std::to_string(sensor.fewest_beams);
  if (sensor.most_beams != sensor.fewest_beams) text += " to " + std::to_string(sensor.most_beams);
  return text + (sensor.has_uneven_beams ? ", unevenly spaced," : "");
}

/// Returns a line for each oddity of the sweeps of a sensor.
std::string oddities_text(const LogSummary::Sensor& sensor) {
  std::string all;
  const auto add = [&](std::size_t count, const char* what) {
    if (count > 0) all += "  " + std::string(what) + " " + std::to_string(count) + " sub-scans\n";
  };
  add(sensor.num_without_readings, "no readings in");
  add(sensor.num_without_returns, "no returns in");
  if (sensor.is_upside_down) all += "  mount       upside down\n";
  return all;
}

/// Groups the digits by three.
std::string grouped(std::size_t number) {
  std::string digits = std::to_string(number);
  for (std::size_t at = digits.size(); at > 3;) digits.insert(at -= 3, " ");
  return digits;
}

std::string level_text(const NoReturnLevel& level) {
  char text[160];
  if (level.from_m == level.to_m) {
    std::snprintf(text, sizeof text, "  no returns  %.3f m: ", level.from_m);
  } else {
    std::snprintf(text, sizeof text, "  no returns  %.3f to %.3f m: ", level.from_m, level.to_m);
  }
  return text + grouped(level.num_readings) + " readings, taken as no return\n";
}

std::string sensor_text(const LogSummary::Sensor& sensor, const LogSummary& summary) {
  char text[320];
  std::snprintf(text, sizeof text,
                "  sub-scans   %zu\n  beams       %s over %.6g deg\n  returns     %.1f %%, %.2f to %.2f m\n",
                sensor.num_sweeps, beams_text(sensor).c_str(), sensor.fov_rad / kDegree, 100.0 * sensor.return_ratio,
                sensor.shortest_return_m, sensor.longest_return_m);
  std::string all = "sensor      " +
                    (sensor.label.empty() ? "(without a label)" : printable(sensor.label, kMostNameShown)) + "\n" +
                    text;
  if (sensor.max_range_m > 0.0) {
    std::snprintf(text, sizeof text, "  max. range  %.6g m\n", sensor.max_range_m);
    all += text;
  } else {
    all += "  max. range  not in the log\n";
  }
  if (sensor.sweep_s > 0.0) {
    std::snprintf(text, sizeof text, "  sweep       %.6g s\n", sensor.sweep_s);
    all += text;
  }
  for (const NoReturnLevel& level : summary.no_returns) {
    if (level.sensor_label == sensor.label) all += level_text(level);
  }
  return all + oddities_text(sensor);
}

}  // namespace

void print_text(const std::string& text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (!written || std::fflush(stdout) != 0) {
    throw OutputError(std::string("cannot write to standard output: ") + std::strerror(errno));
  }
}

void print_line(std::string_view text, std::size_t most) {
  std::fprintf(stderr, "%s: %s\n", kProgramName, printable(text, most).c_str());
}

void print_lines(const std::string& prefix, const std::vector<std::string>& lines, std::size_t max_lines,
                 const std::string& where) {
  for (std::size_t i = 0; i < lines.size() && i < max_lines; ++i) print_line(prefix + lines[i]);
  if (lines.size() > max_lines) {
    print_line(prefix + "... and " + std::to_string(lines.size() - max_lines) + " more" + where);
  }
}

std::string log_summary_text(const LogSummary& summary) {
  char text[160];
  std::snprintf(text, sizeof text, "positions   %zu\nduration    %.3f s\n", summary.num_scans, summary.duration_s);
  std::string all = "format      " + summary.format + "\n" + text;
  for (const LogSummary::Sensor& sensor : summary.sensors) all += sensor_text(sensor, summary);
  return all;
}

}  // namespace shapemap::cli
