// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "costs.hpp"
#include "progress_bar.hpp"
#include "shapemap/io/report.hpp"
#include "shapemap/mapper/mapping_events.hpp"
#include "signals.hpp"

namespace shapemap::cli {

/// Drives the progress bar, keeps warnings for later, and stops the run on Ctrl-C.
class ConsoleObserver : public MappingEvents {
 public:
  explicit ConsoleObserver(bool show_progress, const char* what = "positions") : progress_(show_progress, what) {}

  void on_progress(std::size_t done, std::size_t total) override {
    progress_.update(done, total);
    if (reads_log_ && done >= next_milestone_) {
      milestones_.push_back({done, stopwatch_.seconds(), cpu_seconds(), peak_memory_mib()});
      next_milestone_ = done - done % kMilestone + kMilestone;
    }
  }
  void on_warning(std::string_view message) override { warnings_.emplace_back(message); }
  void on_stage(std::string_view stage) override {
    reads_log_ = stage == "chain";
    const std::string asked_to_stop = interrupted() ? "interrupted; still: " : "";
    const bool by_scan = stage == "chain" || stage == "sweeps";
    progress_.start(asked_to_stop + std::string(stage), by_scan ? "positions" : "pairs");
  }
  bool keep_going() override {
    progress_.tick();
    return !interrupted();
  }

  void finish() { progress_.clear(); }
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// Returns the costs after about each thousand scans that were read.
  const std::vector<Milestone>& milestones() const { return milestones_; }

 private:
  static constexpr std::size_t kMilestone = 1000;

  ProgressBar progress_;
  std::vector<std::string> warnings_;
  Stopwatch stopwatch_;
  bool reads_log_ = false;
  std::size_t next_milestone_ = kMilestone;
  std::vector<Milestone> milestones_;
};

}  // namespace shapemap::cli
