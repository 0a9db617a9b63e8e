// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include "back_end.hpp"
#include "background_events.hpp"

namespace shapemap {

/// A back end that works in a thread of its own, on the scans in their order: what it makes of them is what it would
/// make in the calling thread.
class BackEndThread {
 public:
  /// `events` are those of `context`.
  BackEndThread(BackEndContext context, BackgroundEvents& events);
  /// Stops the work early.
  ~BackEndThread();
  BackEndThread(const BackEndThread&) = delete;
  BackEndThread& operator=(const BackEndThread&) = delete;

  /// Waits while very many scans wait for their turn. Throws what ended the work in the thread.
  void add(TrackedScan scan);

  /// Waits for the scans that wait, and makes the map of all.
  MapResult finish();

 private:
  void work();
  void join();

  BackgroundEvents& events_;
  BackEnd back_end_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<TrackedScan> waiting_;
  bool no_more_come_ = false;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace shapemap
