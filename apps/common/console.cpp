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

std::string sensor_text(const LogSummary::Sensor& sensor) {
  char text[320];
  std::snprintf(text, sizeof text,
                "  sub-scans   %zu\n  beams       %zu over %.6g deg\n  returns     %.1f %%, %.2f to %.2f m\n",
                sensor.num_sub_scans, sensor.num_beams, sensor.fov_rad / kDegree, 100.0 * sensor.return_ratio,
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
  return all;
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
  std::snprintf(text, sizeof text, "positions   %zu\nduration    %.3f s\n", summary.num_positions, summary.duration_s);
  std::string all = "format      " + summary.format + "\n" + text;
  for (const LogSummary::Sensor& sensor : summary.sensors) all += sensor_text(sensor);
  return all;
}

}  // namespace shapemap::cli
