// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace shapemap::cli {

/// The line of a bar of `width` characters with rate and time left.
std::string progress_line(std::size_t done, std::size_t total, const char* what, double elapsed_s, std::size_t width);

/// Draws on stderr, over and over on one line, at most ten times a second; nothing unless stderr is a terminal.
class ProgressBar {
 public:
  /// `what` is counted.
  ProgressBar(bool enabled, const char* what);
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void update(std::size_t done, std::size_t total);
  /// Takes the bar off the screen, so that other lines can follow.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  bool enabled_;
  const char* what_;
  bool visible_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_drawn_;
};

}  // namespace shapemap::cli
