// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include "back_end.hpp"

namespace shapemap {

/// A back end that works in a thread of its own, on the scans in their order: what it makes of them is what it would
/// make in the calling thread.
class BackEndThread {
 public:
  /// The observer of `context` is asked and told from the calling thread only, in finish().
  explicit BackEndThread(BackEndContext context);
  /// Stops the work early.
  ~BackEndThread();
  BackEndThread(const BackEndThread&) = delete;
  BackEndThread& operator=(const BackEndThread&) = delete;

  /// Waits while very many scans wait for their turn. Throws what ended the work in the thread.
  void add(TrackedScan scan);

  /// Waits for the scans that wait, and makes the map of all.
  MapResult finish();

 private:
  /// The observer of the back end: in the thread it only knows whether to stop.
  class Observer : public RunObserver {
   public:
    explicit Observer(RunObserver& observer) : observer_(observer) {}
    void on_stage(std::string_view stage) override;
    void on_progress(std::size_t done, std::size_t total) override;
    void on_warning(std::string_view message) override;
    bool keep_going() override;

    void stop() { is_stopped_ = true; }
    void hand_back() { is_handed_back_ = true; }

   private:
    RunObserver& observer_;
    std::atomic<bool> is_stopped_{false};
    std::atomic<bool> is_handed_back_{false};
  };

  void work();
  void join();

  Observer observer_;
  BackEnd back_end_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<TrackedScan> waiting_;
  bool no_more_come_ = false;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace shapemap
