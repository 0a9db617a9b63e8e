// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <utility>

#include "nist_text.hpp"

namespace shapemap {
namespace {

constexpr const char* kLabel = "laser";

class BareReader {
 public:
  BareReader(ByteSource& source, const LogReadOptions& options) : source_(source), lines_(source), options_(options) {
    log_.format = "bare";
  }

  Log read() {
    if (!(options_.fov_rad > 0.0)) {
      throw InputError(source_.path() + ": lines of numbers do not say their field of view; give --fov-deg");
    }
    LaserChoice choice(options_.sensor_label);
    while (const std::optional<std::string_view> line = lines_.next()) {
      Words words(line->substr(0, line->find('#')), ',');
      if (words.count_left() > 0 && choice.takes(kLabel, true)) add(read_sweep(words));
    }
    choice.report(source_.path(), log_);
    finish_log(source_, log_);
    warn_of_incomplete_scan();
    return std::move(log_);
  }

 private:
  Sweep read_sweep(Words& words) {
    const std::size_t num_beams = words.count_left();
    if (num_beams < 2) throw lines_.error("one number, expected a scan of two or more");
    if (num_beams_ == 0) num_beams_ = num_beams;
    if (num_beams != num_beams_) {
      throw lines_.error(std::to_string(num_beams) + " numbers, but the lines before have " +
                         std::to_string(num_beams_));
    }
    Sweep sweep;
    sweep.sensor_label = kLabel;
    sweep.first_angle_rad = -options_.fov_rad / 2;
    sweep.angle_step_rad = options_.fov_rad / static_cast<double>(num_beams - 1);
    sweep.ranges_m.reserve(num_beams);
    for (std::size_t i = 0; i < num_beams; ++i) {
      const std::string_view word = words.next();
      const std::optional<float> range_m = parse_range(word, 1.0);
      if (!range_m) throw lines_.error("reading " + std::to_string(i + 1) + " is '" + std::string(word) + "'");
      sweep.ranges_m.push_back(*range_m);
    }
    lines_.require_plausible(sweep);
    return sweep;
  }

  void add(Sweep sweep) {
    const auto wanted = static_cast<std::size_t>(options_.sweeps_per_scan);
    if (log_.scans.empty() || log_.scans.back().sweeps.size() == wanted) {
      Scan scan;
      scan.timestamp_s = static_cast<double>(log_.scans.size());  // the format has no times
      log_.scans.push_back(std::move(scan));
    }
    std::vector<Sweep>& sweeps = log_.scans.back().sweeps;
    sweep.nominal_heading_rad = wrap_angle(static_cast<double>(sweeps.size()) * options_.sweep_turn_rad);
    sweeps.push_back(std::move(sweep));
  }

  void warn_of_incomplete_scan() {
    const std::size_t got = log_.scans.back().sweeps.size();
    const auto wanted = static_cast<std::size_t>(options_.sweeps_per_scan);
    if (got == wanted) return;
    log_.warnings.push_back(source_.path() + ": the last position has only " + std::to_string(got) + " of " +
                            std::to_string(wanted) + " sub-scans");
  }

  ByteSource& source_;
  LineReader lines_;
  const LogReadOptions& options_;
  Log log_;
  std::size_t num_beams_ = 0;
};

}  // namespace

Log read_bare(ByteSource& source, const LogReadOptions& options) { return BareReader(source, options).read(); }

}  // namespace shapemap
