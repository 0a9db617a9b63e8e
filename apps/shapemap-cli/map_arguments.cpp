// SPDX-License-Identifier: GPL-3.0-or-later
#include "arguments.hpp"
#include "command_line.hpp"
#include "log_source_flags.hpp"
#include "map_outputs.hpp"
#include "map_picture.hpp"
#include "options_file.hpp"
#include "shapemap/io/report.hpp"

namespace shapemap::cli {
namespace {

constexpr const char* kExamples =
    "Other commands:\n"
    "  shapemap-cli info LOG        what a log holds\n"
    "  shapemap-cli convert IN OUT  a log in another format\n"
    "  shapemap-cli align LOG       what aligning pairs of positions gives\n"
    "  shapemap-cli numbers         the method's fitted weights and tolerances\n"
    "(a log that is called 'info', 'convert', 'align' or 'numbers' is given as ./info)\n\n"
    "Examples:\n"
    "  shapemap-cli --demo --out map.png --draw-path\n"
    "  shapemap-cli robot1.rawlog robot2.log.gz --out map.png --trajectory map.tum\n"
    "  shapemap-cli intel.log.gz --out map.png --trajectory map.tum --report report.json\n"
    "  shapemap-cli --rawlog run.rawlog --sensor-label FRONT --out map.pgm --resolution-m 0.02\n"
    "  shapemap-cli --dump-config --threads 4 > options.toml\n"
    "  shapemap-cli run.log --config options.toml --out map.tif --force\n\n";

void add_outputs(CLI::App& app, MapArguments& arguments) {
  const auto add = [&](const char* name, std::string& path, const char* help) {
    app.add_option(name, path, help)->option_text("FILE")->group("Output");
  };
  add("--out", arguments.map_path,
      "the map, .png, .pgm or .tif, with a .yaml for ROS beside it; example: --out map.png");
  add("--trajectory", arguments.trajectory_path,
      "placed positions as TUM lines, '-' for standard output; example: --trajectory map.tum");
  add("--motions", arguments.motions_path,
      "motions between placed positions with covariances, '-' for standard output; example: --motions map.motions");
  add("--carmen-out", arguments.carmen_path,
      "placed positions as a CARMEN log with poses; example: --carmen-out map.log");
  add("--rawlog-out", arguments.rawlog_path,
      "placed positions as a rawlog with poses; example: --rawlog-out map.rawlog");
  add("--report", arguments.report_path,
      "options, results, timings as JSON, '-' for standard output; example: --report report.json");
  add("--trace", arguments.trace_path,
      "every step that led to the map, a JSON object a line, .gz compresses; example: --trace trace.jsonl");
  app.add_option("--components,--fragments", arguments.fragments_folder,
                 "a map and a trajectory of each component that nothing joins to the map; example: --components apart")
      ->option_text("FOLDER")
      ->group("Output");
  add("--save-state", arguments.state_path,
      "what was aligned, as soon as it is, so that a run that was cut short can be resumed; example: --save-state "
      "run.state");
  app.add_flag("--resume", arguments.resume, "go on from the file that --save-state names")->group("Output");
  app.add_flag("--force", arguments.force, "replace outputs that exist")->group("Output");
}

void check_out(const MapArguments& arguments) {
  if (arguments.map_path.empty()) throw ConfigError("no map asked for; give --out map.png, .pgm or .tif");
  check_map_path("--out", arguments.map_path);
  if (!arguments.motions_path.empty() && arguments.settings.mapping.run.method != Method::kRobust) {
    throw ConfigError("--motions needs --method robust: the paper's method has no covariances");
  }
  if (arguments.logs.size() < 2) return;
  if (arguments.settings.mapping.run.method != Method::kRobust) {
    throw ConfigError("several logs need --method robust: the paper's method never joins what it has not chained");
  }
  for (const auto& [option, path] : per_log_outputs(arguments)) {
    if (!is_stream(path)) continue;
    throw ConfigError(std::string(option) + " '" + path + "' is no file; with several logs, each gets one of its own");
  }
}

std::string version_text() {
  std::string text;
  for (const auto& [name, version] : component_versions()) {
    text += text.empty() ? "shapemap-cli " + version : "\n  " + name + " " + version;
  }
  return text;
}

}  // namespace

std::optional<MapArguments> parse_map_arguments(const std::vector<std::string>& typed) {
  MapArguments arguments;
  LogSourceFlags sources;
  bool strict_paper = false;
  bool quiet = false;
  bool verbose = false;
  const OptionTable table = option_table(arguments.settings);

  CLI::App app("A 2D map from laser scans alone, without odometry.", "shapemap-cli");
  app.footer(kExamples + exit_code_help());
  app.set_version_flag("--version", version_text(), "print versions and exit");
  sources.add(app);
  add_outputs(app, arguments);
  CLI::Option* quiet_flag = app.add_flag("--quiet", quiet, "print errors only");
  app.add_flag("--verbose", verbose, "print what the log holds, times, and all positions without a place")
      ->excludes(quiet_flag);
  app.add_option("--config", arguments.config_path,
                 "options file; what is typed wins over it; example: --config options.toml")
      ->option_text("FILE.toml");
  app.add_flag("--dump-config", arguments.dump_config, "print the options file for what is in effect, and exit");
  app.add_flag("--strict-paper", strict_paper,
               "start from the paper's literal readings instead of the better settings");
  const TableFlags flags(app, table);
  if (!parse(app, typed)) return std::nullopt;

  if (strict_paper) make_strict_paper(arguments.settings.mapping);
  if (!arguments.config_path.empty()) apply_options_file(table, arguments.config_path);
  flags.apply();
  validate_all(arguments.settings.mapping);
  if (verbose) arguments.verbosity = Verbosity::kVerbose;
  if (quiet) arguments.verbosity = Verbosity::kQuiet;
  if (arguments.dump_config) return arguments;
  arguments.logs = sources.take(app, typed);
  check_out(arguments);
  return arguments;
}

}  // namespace shapemap::cli
