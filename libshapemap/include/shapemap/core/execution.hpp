// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shapemap/core/observer.hpp"

namespace shapemap {

/// Says how a long computation runs; nothing of it changes a result.
struct Execution {
  int threads = 1;  ///< 0 takes one thread per processor
  RunObserver& observer;
};

}  // namespace shapemap
