// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "shapemap/scan/scan.hpp"

/// This header tells where the beams of a sweep point, also where the log contradicts itself about it.
namespace shapemap {

/// A log header states these directions of the beams. Missing or non-finite numbers state nothing.
struct StatedAngles {
  double first_rad = 0.0;
  std::optional<double> step_rad;
  std::optional<double> last_rad;
};

enum class AngleSource {
  kAsStated,  ///< step and last angle agree within one and a half steps, or only one of them is stated
  kStep,      ///< step and last angle disagree, and the step is used
  kLimits,    ///< the step is impossible: it is 0, goes the other way, or makes more than a turn
};

struct EvenBeams {
  double first_rad = 0.0;
  double step_rad = 0.0;
  AngleSource source = AngleSource::kAsStated;
};

/// Returns the evenly spaced beams that a header with `num_beams` readings means. The step counts where it is possible,
/// since programs that draw scans use it; otherwise the first and last angle do. Returns nothing when neither can be
/// right.
std::optional<EvenBeams> even_beams(const StatedAngles& stated, std::size_t num_beams);

/// Gives each reading of `sweep` an angle; `angles_rad` is in the order of the readings.
void set_beam_angles(Sweep& sweep, std::vector<double> angles_rad);

/// Puts the returns of a sweep on evenly spaced beams, for formats that have no others: each reading goes to the
/// nearest beam, and the shorter of two that meet there stays. An evenly spaced sweep is returned unchanged.
Sweep on_even_beams(const Sweep& sweep);

}  // namespace shapemap
