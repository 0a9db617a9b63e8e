// SPDX-License-Identifier: GPL-3.0-or-later
#include "arguments.hpp"

#include "command_line.hpp"
#include "map_picture.hpp"
#include "shapemap/core/errors.hpp"

namespace shapemap::baselines {
namespace {

constexpr const char* kFooter =
    "METHOD: mrpt-icp, ICP to a map of points (MRPT's CMetricMapBuilderICP); mrpt-rbpf, a particle filter with a grid\n"
    "map a particle (MRPT's CMetricMapBuilderRBPF); vasco, maximum likelihood scan by scan in the manner of CARMEN.\n"
    "Odometry and poses in the log are never used: the methods get that of --poses or --covariances, or none.\n\n"
    "Examples:\n"
    "  shapemap-baselines vasco intel.log.gz --trajectory vasco.tum --map vasco.png\n"
    "  shapemap-cli intel.log.gz --out map.png --trajectory map.tum --motions map.motions\n"
    "  shapemap-baselines mrpt-rbpf intel.log.gz --poses map.tum --covariances map.motions --trajectory rbpf.tum\n\n"
    "Exit codes: 0 all positions placed; 1 unexpected failure; 2 wrong usage; 3 unreadable or malformed input, "
    "nothing\n"
    "written; 4 written, some positions not placed; 5 cannot write; 130 interrupted.";

void add_files(CLI::App& app, Arguments& arguments) {
  const auto add = [&](const char* name, std::string& path, const char* group, const char* help) {
    app.add_option(name, path, help)->option_text("FILE")->group(group);
  };
  add("--poses", arguments.motions.poses_path, "Input",
      "estimated poses as TUM lines, whose relative motions are given as odometry; example: --poses map.tum");
  add("--covariances", arguments.motions.covariances_path, "Input",
      "motions and their covariances, the motion model of mrpt-rbpf and vasco; without --poses the motions count too; "
      "example: --covariances map.motions");
  add("--trajectory", arguments.trajectory_path, "Output",
      "placed positions as TUM lines, '-' for standard output; example: --trajectory vasco.tum");
  add("--map", arguments.map_path, "Output",
      "the map, .png, .pgm or .tif, with a .yaml for ROS beside it; example: --map vasco.png");
  app.add_flag("--force", arguments.force, "replace outputs that exist")->group("Output");
}

void check(const Arguments& arguments) {
  if (arguments.trajectory_path.empty()) throw ConfigError("no trajectory asked for; give --trajectory FILE");
  if (!arguments.map_path.empty()) cli::check_map_path("--map", arguments.map_path);
  if (arguments.method == BaselineMethod::kMrptIcp && !arguments.motions.covariances_path.empty()) {
    throw ConfigError("--covariances is for mrpt-rbpf and vasco: mrpt-icp has no motion model");
  }
}

}  // namespace

std::optional<Arguments> parse_arguments(const std::vector<std::string>& typed) {
  Arguments arguments;
  std::string method;
  cli::FormatText from;
  const cli::OptionTable table = cli::option_table(arguments.settings);

  CLI::App app("Maps a laser log by other methods, to compare shapemap with.", "shapemap-baselines");
  app.footer(kFooter);
  app.add_option("METHOD", method, "mrpt-icp, mrpt-rbpf or vasco")->required()->option_text(" ");
  app.add_option("LOG", arguments.log_path, "log to map")->required()->option_text(" ");
  from.add(app, "--from", "format of the log; auto: by its content; example: --from carmen");
  add_files(app, arguments);
  app.add_flag("--quiet", arguments.quiet, "print errors only");
  const cli::TableFlags flags(app, table);
  if (!cli::parse(app, typed)) return std::nullopt;

  flags.apply();
  arguments.format = from.format("from");
  try {
    arguments.method = enum_from_name<BaselineMethod>(method);
  } catch (const ConfigError& e) {
    throw ConfigError(std::string("METHOD: ") + e.what());
  }
  check(arguments);
  return arguments;
}

}  // namespace shapemap::baselines
