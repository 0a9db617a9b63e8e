// SPDX-License-Identifier: GPL-3.0-or-later
#include "back_end_thread.hpp"
#include "mapper_numbers.hpp"

#include <utility>

namespace shapemap {
namespace {

BackEndContext observed_by(BackEndContext context, RunObserver& observer) {
  return {context.options, observer, context.sink, context.cache, std::move(context.publish)};
}

}  // namespace

void BackEndThread::Observer::on_stage(std::string_view stage) {
  if (is_handed_back_) observer_.on_stage(stage);
}

void BackEndThread::Observer::on_progress(std::size_t done, std::size_t total) {
  if (is_handed_back_) observer_.on_progress(done, total);
}

void BackEndThread::Observer::on_warning(std::string_view message) {
  if (is_handed_back_) observer_.on_warning(message);
}

bool BackEndThread::Observer::keep_going() { return !is_stopped_ && (!is_handed_back_ || observer_.keep_going()); }

BackEndThread::BackEndThread(BackEndContext context)
    : observer_(context.observer), back_end_(observed_by(std::move(context), observer_)) {
  thread_ = std::thread([this] { work(); });
}

BackEndThread::~BackEndThread() {
  observer_.stop();
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
  observer_.hand_back();
  return back_end_.finish();
}

void BackEndThread::work() {
  try {
    for (;;) {
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait(lock, [this] { return !waiting_.empty() || no_more_come_; });
      if (waiting_.empty() || !observer_.keep_going()) return;
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
