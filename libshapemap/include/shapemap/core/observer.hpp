// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string_view>

namespace shapemap {

/// How a caller watches and stops a long run; the library itself never prints. Calls come from one thread.
struct RunObserver {
  virtual ~RunObserver() = default;
  /// What begins now; on_progress() counts anew from here. Some stages have no progress.
  virtual void on_stage(std::string_view /*stage*/) {}
  virtual void on_progress(std::size_t /*done*/, std::size_t /*total*/) {}
  virtual void on_warning(std::string_view /*message*/) {}
  /// Asked before each position and between the steps of its alignment; false ends the run with what has been mapped
  /// so far.
  virtual bool keep_going() { return true; }
};

}  // namespace shapemap
