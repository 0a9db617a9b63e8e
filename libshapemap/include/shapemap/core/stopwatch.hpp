// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>

namespace shapemap {

/// Measures wall time from its construction on.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

  /// Returns the seconds since the last lap, or since the construction, and begins a new lap.
  double lap_s() {
    const double lap = seconds();
    start_ = std::chrono::steady_clock::now();
    return lap;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace shapemap
