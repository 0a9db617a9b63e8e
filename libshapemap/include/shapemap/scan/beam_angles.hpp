// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "shapemap/scan/scan.hpp"

/// Where the beams of a scan point, also where its header contradicts itself.
namespace shapemap {

/// What a header says of the directions of its beams. Numbers that are missing or not finite say nothing.
struct StatedAngles {
  double first_rad = 0.0;
  std::optional<double> step_rad;
  std::optional<double> last_rad;
};

enum class AngleSource {
  kAsStated,  ///< step and last angle agree within one and a half steps, or only one of them is stated
  kStep,      ///< they disagree, and the step is used
  kLimits,    ///< the step cannot be: it is 0, goes the other way, or makes more than a turn
};

struct EvenBeams {
  double first_rad = 0.0;
  double step_rad = 0.0;
  AngleSource source = AngleSource::kAsStated;
};

/// The even beams that a header with `num_beams` readings means. The step counts where it is possible, since programs
/// that draw scans use it; otherwise the first and last angle do. Nothing when neither can be right.
std::optional<EvenBeams> even_beams(const StatedAngles& stated, std::size_t num_beams);

/// Gives `scan` an angle for each of its readings, in the order of the readings.
void set_beam_angles(Sweep& sweep, std::vector<double> angles_rad);

/// The same hits on evenly spaced beams, for formats that have no others: each reading goes to the nearest beam, and
/// the nearer of two that meet there stays. A scan that is evenly spaced stays as it is.
Sweep on_even_beams(const Sweep& sweep);

}  // namespace shapemap
