// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/core/parallel_for.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

namespace shapemap {

void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto take_work = [&] {
    try {
      for (std::size_t i = next++; i < count; i = next++) work(i);
    } catch (...) {
      const std::lock_guard<std::mutex> lock(failure_mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  std::vector<std::thread> helpers;
  const auto wanted =
      threads > 0 ? static_cast<std::size_t>(threads) : std::max<std::size_t>(1, std::thread::hardware_concurrency());
  const std::size_t num_helpers = std::min(count, wanted) - (count > 0 ? 1 : 0);
  try {
    for (std::size_t t = 0; t < num_helpers; ++t) helpers.emplace_back(take_work);
  } catch (const std::system_error&) {
    // The system gives no more threads, so the existing ones do all the work.
  } catch (const std::bad_alloc&) {
    // The memory for one more thread is missing, so the existing ones do all the work.
  }
  take_work();
  for (std::thread& helper : helpers) helper.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace shapemap
