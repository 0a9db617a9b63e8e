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

/// Returns the user and system time of all threads of this process since its start.
double cpu_seconds();
double peak_memory_mib();

}  // namespace shapemap::cli
