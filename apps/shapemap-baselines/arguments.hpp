// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "motions.hpp"
#include "mrpt_icp.hpp"
#include "mrpt_rbpf.hpp"
#include "shapemap/grid/occupancy_grid.hpp"
#include "shapemap/io/log_file.hpp"
#include "shapemap/io/log_selection.hpp"
#include "vasco.hpp"

namespace shapemap::baselines {

enum class BaselineMethod { kMrptIcp, kMrptRbpf, kVasco };

struct RunOptions {
  int seed = 1;
  double max_seconds = 0.0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"seed", "the random numbers of mrpt-rbpf begin with", 0, 2147483647}, self.seed);
    visit(Field{"max-seconds", "after so long the rest of the log is left out [s]; 0: never", 0, 1e9},
          self.max_seconds);
  }
};

struct BaselineSettings {
  RunOptions run;
  LogReadOptions reading;
  SelectionOptions selection;
  ReturnOptions returns;
  MotionOptions motion;
  IcpOptions icp;
  RbpfOptions rbpf;
  VascoOptions vasco;
  OccupancyGridOptions grid;

  template <class Self, class Visit>
  static void groups(Self& self, Visit&& visit) {
    visit("Run", self.run);
    visit("Reading", self.reading);
    visit("Selection", self.selection);
    visit("Returns", self.returns);
    visit("Motion", self.motion);
    visit("mrpt-icp", self.icp);
    visit("mrpt-rbpf", self.rbpf);
    visit("vasco", self.vasco);
    visit("Map", self.grid);
  }
};

struct Arguments {
  BaselineMethod method = BaselineMethod::kVasco;
  std::string log_path;
  LogFormat format = LogFormat::kAuto;
  MotionSources motions;
  std::string trajectory_path;
  std::string map_path;  ///< no map is wanted when this is empty
  bool force = false;
  bool quiet = false;
  BaselineSettings settings;
};

/// Parses the arguments after the program's name. Returns nothing when help or the version was asked for and printed.
/// Throws ConfigError for wrong usage.
std::optional<Arguments> parse_arguments(const std::vector<std::string>& typed);

}  // namespace shapemap::baselines

namespace shapemap {

template <>
struct EnumNames<baselines::BaselineMethod> {
  static constexpr std::array<std::string_view, 3> names{"mrpt-icp", "mrpt-rbpf", "vasco"};
};

}  // namespace shapemap
