// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/core/parallel_for.hpp"

#include <gtest/gtest.h>
#include <pthread.h>

#include <atomic>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <vector>

namespace shapemap {
namespace {

TEST(ParallelFor, CoversEveryIndexOnceForAnyNumberOfThreads) {
  for (const int threads : {-1, 0, 1, 2, 3, 8, 40}) {
    for (const std::size_t count : {0U, 1U, 2U, 7U, 500U}) {
      std::vector<std::atomic<int>> calls(count);
      parallel_for(count, threads, [&](std::size_t i) { ++calls.at(i); });
      for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(calls[i], 1) << i << " of " << count << ", " << threads;
    }
  }
}

TEST(ParallelFor, RethrowsWhatTheWorkThrows) {
  for (const int threads : {1, 4}) {
    const auto work = [](std::size_t i) {
      if (i == 17) throw std::out_of_range("seventeen");
    };
    EXPECT_THROW(parallel_for(100, threads, work), std::out_of_range) << threads;
  }
}

TEST(ParallelFor, RethrowsOneOfManyFailures) {
  const auto work = [](std::size_t) { throw std::length_error("each"); };
  EXPECT_THROW(parallel_for(100, 4, work), std::length_error);
}

TEST(ParallelFor, HasNoThreadLeftWhenItReturns) {
  std::atomic<int> running{0};
  parallel_for(64, 8, [&](std::size_t) {
    ++running;
    std::this_thread::yield();
    --running;
  });
  EXPECT_EQ(running, 0);
}

TEST(ParallelFor, WithOneThreadWorksInOrderOnTheCallingThread) {
  const std::thread::id caller = std::this_thread::get_id();
  std::vector<std::size_t> order;
  parallel_for(5, 1, [&](std::size_t i) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    order.push_back(i);
  });
  EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
}

/// While it lives, no thread can be started, since none has so much room for its stack.
class NoMoreThreads {
 public:
  NoMoreThreads() {
    pthread_getattr_default_np(&before_);
    pthread_attr_t huge;
    pthread_getattr_default_np(&huge);
    pthread_attr_setstacksize(&huge, std::size_t{1} << 47U);
    pthread_setattr_default_np(&huge);
    pthread_attr_destroy(&huge);
  }
  ~NoMoreThreads() {
    pthread_setattr_default_np(&before_);
    pthread_attr_destroy(&before_);
  }
  NoMoreThreads(const NoMoreThreads&) = delete;
  NoMoreThreads& operator=(const NoMoreThreads&) = delete;

 private:
  pthread_attr_t before_{};
};

TEST(ParallelFor, DoesAllByItselfWhereNoThreadIsToBeHad) {
  const NoMoreThreads none;
  EXPECT_THROW(std::thread([] {}).join(), std::system_error);
  std::vector<int> done(100, 0);
  parallel_for(done.size(), 8, [&](std::size_t i) { ++done[i]; });
  EXPECT_EQ(done, std::vector<int>(100, 1));
}

}  // namespace
}  // namespace shapemap
