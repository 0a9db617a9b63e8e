// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "shapemap/scan/scan.hpp"

/// Sensors and drivers report "no return" as special distances: an error code, the limit of the sensor, a limit in the
/// driver. These levels are learned from the readings of each sensor of a log, whatever its format; docs/formats.md
/// describes the test and its error.
namespace shapemap {

struct NoReturnChoice {
  bool is_learned = true;
  struct Band {
    double from_m = 0.0;
    double to_m = 0.0;
  };
  std::vector<Band> given;  ///< levels that the user gives, in place of learned ones
};

/// Reads "auto", "none", or levels and bands in metres such as "51.15" or "0.001,51.0-51.2". Throws ConfigError for
/// anything else.
NoReturnChoice no_return_choice(const std::string& text);

/// Finds the levels of no return of each sensor of a log that was just read, marks their readings as no returns and
/// notes the levels in Log::no_returns. A level with only scattered readings beyond it becomes the maximum range of its
/// sensor; on any other level the readings become NaN. A maximum range from a header is given up, with a warning, where
/// surfaces lie far beyond it.
void sort_out_no_returns(Log& log, const NoReturnChoice& choice);

}  // namespace shapemap
