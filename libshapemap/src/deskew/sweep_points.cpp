// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep_points.hpp"

#include <algorithm>

namespace shapemap {

std::vector<SweepPoint> sweep_points(const Scan& scan, const ReturnOptions& options, std::size_t max_points) {
  std::size_t num_beams = 0;
  for (const Sweep& sweep : scan.sweeps) num_beams += sweep.ranges_m.size();
  const std::size_t step = std::max<std::size_t>(1, (num_beams + max_points / 2) / max_points);
  std::vector<SweepPoint> points;
  points.reserve(num_beams / step + scan.sweeps.size());
  for (std::size_t s = 0; s < scan.sweeps.size(); ++s) {
    std::vector<Return> returns = returns_in_robot(scan.sweeps[s], options);
    std::sort(returns.begin(), returns.end(), [](const Return& a, const Return& b) { return a.beam < b.beam; });
    bool begins_line = true;
    for (const Return& hit : returns) {
      if (hit.beam % step != 0) continue;
      points.push_back({hit.p_in_robot_m, s, hit.beam, begins_line});
      begins_line = false;
    }
  }
  return points;
}

}  // namespace shapemap
