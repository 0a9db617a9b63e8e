// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>

namespace shapemap {

/// Calls `work(i)` once for every i below `count`, on up to `threads` threads (0 takes one per processor), and returns
/// when all are done. Fewer threads run where the system gives no more. Which thread takes which i is not fixed, so
/// `work` must write to places of its own. Rethrows the first exception of `work`.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

}  // namespace shapemap
