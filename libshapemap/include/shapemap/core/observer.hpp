// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string_view>

namespace shapemap {

/// A caller watches and stops a long run through an observer; the library itself never prints. All calls come from one
/// thread.
struct RunObserver {
  virtual ~RunObserver() = default;
  /// A stage begins, and on_progress() counts anew from here. Some stages report no progress.
  virtual void on_stage(std::string_view /*stage*/) {}
  virtual void on_progress(std::size_t /*done*/, std::size_t /*total*/) {}
  virtual void on_warning(std::string_view /*message*/) {}
  /// The run asks this before each scan and between the steps of its matching; false ends the run with what has been
  /// mapped so far.
  virtual bool keep_going() { return true; }
};

}  // namespace shapemap
