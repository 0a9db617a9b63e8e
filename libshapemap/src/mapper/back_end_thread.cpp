// SPDX-License-Identifier: GPL-3.0-or-later
#include "back_end_thread.hpp"

#include <utility>

#include "mapper_numbers.hpp"

namespace shapemap {

BackEndThread::BackEndThread(BackEndContext context, BackgroundEvents& events)
    : events_(events), back_end_(std::move(context)) {
  thread_ = std::thread([this] { work(); });
}

BackEndThread::~BackEndThread() {
  events_.stop();
  join();
}

void BackEndThread::add(TrackedScan scan) {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return waiting_.size() < kMapper.updates.most_waiting || failure_; });
  if (failure_) std::rethrow_exception(failure_);
  waiting_.push_back(std::move(scan));
  lock.unlock();
  changed_.notify_all();
}

MapResult BackEndThread::finish() {
  join();
  if (failure_) std::rethrow_exception(failure_);
  events_.hand_back();
  return back_end_.finish();
}

void BackEndThread::work() {
  try {
    for (;;) {
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait(lock, [this] { return !waiting_.empty() || no_more_come_; });
      if (waiting_.empty() || !events_.keep_going()) return;
      TrackedScan scan = std::move(waiting_.front());
      waiting_.pop_front();
      lock.unlock();
      changed_.notify_all();
      back_end_.add(std::move(scan));
    }
  } catch (...) {
    const std::lock_guard<std::mutex> lock(mutex_);
    failure_ = std::current_exception();
    changed_.notify_all();
  }
}

void BackEndThread::join() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    no_more_come_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

}  // namespace shapemap
