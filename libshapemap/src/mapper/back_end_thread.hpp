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

/// A back end that works in a thread of its own, on the scans in their order, so that its result is the same as in the
/// calling thread.
class BackEndThread {
 public:
  /// `events` must be those of `context`.
  BackEndThread(BackEndContext context, BackgroundEvents& events);
  /// Stops the work early.
  ~BackEndThread();
  BackEndThread(const BackEndThread&) = delete;
  BackEndThread& operator=(const BackEndThread&) = delete;

  /// Blocks while the queue of scans is full. Rethrows the exception that ended the work in the thread.
  void add(TrackedScan scan);

  /// Waits until the queue is empty, and returns the map of all scans.
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
