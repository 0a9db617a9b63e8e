// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <mutex>

#include "shapemap/mapper/mapping_events.hpp"

namespace shapemap {

/// Passes the events of two threads on, one at a time. Stages, progress, and the question whether to go on belong to
/// the calling thread alone, and are passed on only after the other thread has ended.
class BackgroundEvents : public MappingEvents {
 public:
  explicit BackgroundEvents(MappingEvents& events) : events_(events) {}

  /// Ends the work of the other thread early.
  void stop() { is_stopped_ = true; }
  /// Tells the object that the other thread has ended.
  void hand_back() { is_handed_back_ = true; }

  void on_stage(std::string_view stage) override {
    if (is_handed_back_) events_.on_stage(stage);
  }
  void on_progress(std::size_t done, std::size_t total) override {
    if (is_handed_back_) events_.on_progress(done, total);
  }
  bool keep_going() override { return !is_stopped_ && (!is_handed_back_ || events_.keep_going()); }

  void on_warning(std::string_view message) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    events_.on_warning(message);
  }
  void on_shape(std::size_t scan_index, const std::vector<ShapePoint>& points) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    events_.on_shape(scan_index, points);
  }
  void on_scan(const ScanUpdate& scan) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    events_.on_scan(scan);
  }
  void on_edge(const EdgeFound& edge) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    events_.on_edge(edge);
  }
  void on_loop(const LoopJudged& loop) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    events_.on_loop(loop);
  }
  void on_culled(const KeyframesCulled& culled) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    events_.on_culled(culled);
  }
  void on_localization(const RobotLocalized& localized) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    events_.on_localization(localized);
  }
  void on_map(const Map& map) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    events_.on_map(map);
  }
  void on_edge_verified(const EdgeVerified& edge) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    events_.on_edge_verified(edge);
  }
  void on_edge_chosen(const EdgeChosen& edge) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    events_.on_edge_chosen(edge);
  }

 private:
  MappingEvents& events_;
  std::mutex mutex_;
  std::atomic<bool> is_stopped_{false};
  std::atomic<bool> is_handed_back_{false};
};

}  // namespace shapemap
