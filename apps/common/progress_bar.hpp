// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace shapemap::cli {

/// A bar shows this state.
struct Progress {
  std::string stage;      ///< what runs now; empty where all is one stage
  const char* what = "";  ///< name of the things that are counted
  std::size_t done = 0;
  std::size_t total = 0;   ///< 0 is unknown; then a time is shown in place of a bar
  double elapsed_s = 0.0;  ///< since the stage began
};

/// Returns the line of a bar of `width` characters with rate and time left.
std::string progress_line(const Progress& progress, std::size_t width);

/// Redraws one line on stderr, at most ten times a second, and only if stderr is a terminal.
class ProgressBar {
 public:
  /// `what` names the things that are counted.
  ProgressBar(bool enabled, const char* what);
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Starts a stage, in which `what` is counted from 0.
  void start(std::string stage, const char* what);
  /// Within a stage the bar never goes back.
  void update(std::size_t done, std::size_t total);
  /// Shows the time, whether there is progress or not.
  void tick();
  /// Takes the bar off the screen, so that other lines can follow.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  void draw(bool at_once);

  bool enabled_;
  Progress progress_;
  bool visible_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_drawn_;
};

}  // namespace shapemap::cli
