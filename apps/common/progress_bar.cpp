// SPDX-License-Identifier: GPL-3.0-or-later
#include "progress_bar.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace shapemap::cli {
namespace {

std::string duration_text(double seconds) {
  const long whole = std::lround(seconds);
  char text[32];
  std::snprintf(text, sizeof text, "%ld:%02ld", whole / 60, whole % 60);
  return text;
}

}  // namespace

std::string progress_line(const Progress& progress, std::size_t width) {
  std::string line = progress.stage + (progress.stage.empty() ? "" : " ");
  if (progress.total == 0) return line + duration_text(progress.elapsed_s);
  const std::size_t filled = width * progress.done / progress.total;
  line += "[" + std::string(filled, '=') + std::string(width - filled, ' ') + "] " + std::to_string(progress.done) +
          "/" + std::to_string(progress.total);
  if (progress.done > 0 && progress.elapsed_s > 0.0) {
    const double rate = static_cast<double>(progress.done) / progress.elapsed_s;
    char text[32];
    std::snprintf(text, sizeof text, "  %.1f ", rate);
    line += std::string(text) + progress.what + "/s  ETA " +
            duration_text(static_cast<double>(progress.total - progress.done) / rate);
  }
  return line;
}

ProgressBar::ProgressBar(bool enabled, const char* what) : enabled_(enabled && ::isatty(STDERR_FILENO) == 1) {
  progress_.what = what;
}

void ProgressBar::start(std::string stage, const char* what) {
  progress_ = {std::move(stage), what, 0, 0, 0.0};
  start_ = Clock::now();
  draw(true);
}

void ProgressBar::update(std::size_t done, std::size_t total) {
  if (total != progress_.total) progress_.done = 0;
  progress_.total = total;
  progress_.done = std::min(std::max(progress_.done, done), total);
  draw(done == total || !visible_);
}

void ProgressBar::tick() {
  if (visible_) draw(false);
}

void ProgressBar::draw(bool at_once) {
  if (!enabled_) return;
  const Clock::time_point now = Clock::now();
  if (!at_once && now - last_drawn_ < std::chrono::milliseconds(100)) return;
  last_drawn_ = now;
  visible_ = true;
  progress_.elapsed_s = std::chrono::duration<double>(now - start_).count();
  std::fprintf(stderr, "\r\033[K%s", progress_line(progress_, 30).c_str());
  std::fflush(stderr);
}

void ProgressBar::clear() {
  if (!visible_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  visible_ = false;
}

}  // namespace shapemap::cli
