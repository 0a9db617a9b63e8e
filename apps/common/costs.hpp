// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>

namespace shapemap::cli {

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Of this process since its start, user and system time of all threads.
double cpu_seconds();
double peak_memory_mib();

}  // namespace shapemap::cli
