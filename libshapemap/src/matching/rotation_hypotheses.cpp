// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/matching/rotation_hypotheses.hpp"

#include <algorithm>

namespace shapemap {
namespace {

TangentHistogram circular_correlation(const TangentHistogram& reference, const TangentHistogram& query) {
  std::array<double, 2 * kTangentBins> twice{};
  std::copy(reference.begin(), reference.end(), twice.begin());
  std::copy(reference.begin(), reference.end(), twice.begin() + kTangentBins);
  TangentHistogram correlation{};
  for (std::size_t bin = 0; bin < kTangentBins; ++bin) {
    if (query[bin] == 0.0) continue;
    for (std::size_t turn = 0; turn < kTangentBins; ++turn) correlation[turn] += query[bin] * twice[bin + turn];
  }
  return correlation;
}

}  // namespace

std::vector<double> rotation_hypotheses(const TangentHistogram& reference, const TangentHistogram& query,
                                        int max_count) {
  const TangentHistogram correlation = circular_correlation(reference, query);
  struct Peak {
    double height;
    double rotation_deg;
  };
  std::vector<Peak> peaks;
  for (std::size_t turn = 0; turn < kTangentBins; ++turn) {
    const double before = correlation[(turn + kTangentBins - 1) % kTangentBins];
    const double here = correlation[turn];
    const double after = correlation[(turn + 1) % kTangentBins];
    if (here <= 0.0 || here < before || here <= after) continue;
    const double curvature = before - 2.0 * here + after;
    const double shift = curvature < 0.0 ? 0.5 * (before - after) / curvature : 0.0;
    peaks.push_back({here, static_cast<double>(turn) + shift});
  }
  std::stable_sort(peaks.begin(), peaks.end(), [](const Peak& a, const Peak& b) { return a.height > b.height; });
  std::vector<double> rotations_rad;
  for (const Peak& peak : peaks) {
    if (rotations_rad.size() == static_cast<std::size_t>(max_count)) break;
    rotations_rad.push_back(wrap_angle(peak.rotation_deg * kDegree));
  }
  return rotations_rad;
}

}  // namespace shapemap
