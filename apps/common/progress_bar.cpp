// SPDX-License-Identifier: GPL-3.0-or-later
#include "progress_bar.hpp"

#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace shapemap::cli {
namespace {

std::string duration_text(double seconds) {
  const long whole = std::lround(seconds);
  char text[32];
  std::snprintf(text, sizeof text, "%ld:%02ld", whole / 60, whole % 60);
  return text;
}

}  // namespace

std::string progress_line(std::size_t done, std::size_t total, const char* what, double elapsed_s, std::size_t width) {
  const std::size_t filled = total > 0 ? width * done / total : 0;
  std::string line = "[" + std::string(filled, '=') + std::string(width - filled, ' ') + "] " + std::to_string(done) +
                     "/" + std::to_string(total);
  if (done > 0 && elapsed_s > 0.0) {
    const double rate = static_cast<double>(done) / elapsed_s;
    char text[32];
    std::snprintf(text, sizeof text, "  %.1f ", rate);
    line += std::string(text) + what + "/s  ETA " + duration_text(static_cast<double>(total - done) / rate);
  }
  return line;
}

ProgressBar::ProgressBar(bool enabled, const char* what)
    : enabled_(enabled && ::isatty(STDERR_FILENO) == 1), what_(what) {}

void ProgressBar::update(std::size_t done, std::size_t total) {
  if (!enabled_) return;
  const Clock::time_point now = Clock::now();
  if (visible_ && done < total && now - last_drawn_ < std::chrono::milliseconds(100)) return;
  last_drawn_ = now;
  visible_ = true;
  const double elapsed_s = std::chrono::duration<double>(now - start_).count();
  std::fprintf(stderr, "\r\033[K%s", progress_line(done, total, what_, elapsed_s, 30).c_str());
  std::fflush(stderr);
}

void ProgressBar::clear() {
  if (!visible_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  visible_ = false;
}

}  // namespace shapemap::cli
