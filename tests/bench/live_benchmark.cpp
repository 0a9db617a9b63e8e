// SPDX-License-Identifier: GPL-3.0-or-later
// Prints the distribution of the milliseconds that Mapper::add_scan() takes when the scans of a recording are pushed as
// a sensor delivers them, with the work on the whole map in a thread of its own.
//
// usage: shapemap_live_benchmark LOG [SPEED [MOST_SCANS]]
//   SPEED       times as fast as recorded (default 10); 0: each scan as soon as the one before is done
//   MOST_SCANS  only so many scans from the start of the log
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <thread>
#include <vector>

#include "shapemap/io/log_file.hpp"
#include "shapemap/mapper/mapper.hpp"

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double percentile(const std::vector<double>& sorted, double share) {
  const auto last = static_cast<double>(sorted.size() - 1);
  return sorted[static_cast<std::size_t>(share * last)];
}

int measure(const char* path, double speed, std::size_t most_scans) {
  shapemap::Log log = shapemap::read_log(path);
  log.scans.resize(std::min(log.scans.size(), most_scans));
  if (log.scans.empty()) return 1;
  shapemap::MappingOptions options;
  options.run.threads = 1;
  shapemap::LiveOptions live;
  live.in_background = true;
  shapemap::Mapper mapper(options, live);
  std::vector<double> took_ms;
  std::size_t num_late = 0;
  const auto start = Clock::now();
  for (const shapemap::Scan& scan : log.scans) {
    if (speed > 0.0) {
      const double due_s = (scan.timestamp_s - log.scans.front().timestamp_s) / speed;
      const auto due = start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(due_s));
      if (Clock::now() > due + std::chrono::milliseconds(50)) ++num_late;
      std::this_thread::sleep_until(due);
    }
    const auto before = Clock::now();
    mapper.add_scan(scan);
    took_ms.push_back(milliseconds_since(before));
  }
  const double pushed_s = milliseconds_since(start) / 1000.0;
  const auto map = mapper.map();
  const auto before_end = Clock::now();
  const shapemap::MapResult result = mapper.finish();
  const double finish_s = milliseconds_since(before_end) / 1000.0;
  std::sort(took_ms.begin(), took_ms.end());
  std::printf("scans %zu, placed %zu, speed %g, pushed in %.1f s, finished in %.1f s\n", took_ms.size(),
              result.placed().size(), speed, pushed_s, finish_s);
  std::printf("maps before the last %llu, over 50 ms late %zu\n",
              static_cast<unsigned long long>(map ? map->version : 0), num_late);
  for (const double share : {0.5, 0.9, 0.95, 0.99, 0.999, 1.0}) {
    std::printf("%5.1f %% of add_scan() take at most %8.2f ms\n", 100.0 * share, percentile(took_ms, share));
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 4) {
    std::fprintf(stderr, "usage: %s LOG [SPEED [MOST_SCANS]]\n", argv[0]);
    return 2;
  }
  try {
    return measure(argv[1], argc > 2 ? std::atof(argv[2]) : 10.0,
                   argc > 3 ? static_cast<std::size_t>(std::atol(argv[3])) : static_cast<std::size_t>(-1));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 3;
  }
}
