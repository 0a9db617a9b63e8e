// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <utility>

#include "arguments.hpp"
#include "command_line.hpp"
#include "demo_log.hpp"
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
    "(a log that is called 'info', 'convert' or 'align' is given as ./info)\n\n"
    "Examples:\n"
    "  shapemap-cli --demo --out map.png --draw-path\n"
    "  shapemap-cli intel.log.gz --out map.png --trajectory map.tum --report report.json\n"
    "  shapemap-cli --rawlog run.rawlog --sensor-label FRONT --out map.pgm --resolution-m 0.02\n"
    "  shapemap-cli --dump-config --threads 4 > options.toml\n"
    "  shapemap-cli run.log --config options.toml --out map.tif --force\n\n";

/// The ways to name the log; exactly one is used.
struct Source {
  std::string any, rawlog, carmen, nist;
  bool demo = false;
};

void add_source(CLI::App& app, Source& source) {
  app.add_option("LOG", source.any, "log to map; its format is recognised from its content")->option_text(" ");
  const auto add = [&](const char* name, std::string& path, const char* help) {
    app.add_option(name, path, help)->option_text("LOG")->group("Input");
  };
  add("--rawlog", source.rawlog, "an MRPT rawlog, plain or gzip; example: --rawlog run.rawlog");
  add("--carmen", source.carmen, "a CARMEN log, plain or gzip; example: --carmen intel.log.gz");
  add("--nist", source.nist, "a NIST text log or bare numbers; example: --nist arena.nist");
  app.add_flag("--demo", source.demo, "map the log that comes with shapemap; example: --demo --out map.png")
      ->group("Input");
}

void take_source(const Source& source, MapArguments& arguments) {
  const std::array<std::pair<const std::string*, LogFormat>, 4> given{{{&source.any, LogFormat::kAuto},
                                                                       {&source.rawlog, LogFormat::kRawlog},
                                                                       {&source.carmen, LogFormat::kCarmen},
                                                                       {&source.nist, LogFormat::kNist}}};
  int num_given = source.demo ? 1 : 0;
  for (const auto& [path, format] : given) {
    if (path->empty()) continue;
    ++num_given;
    arguments.log_path = *path;
    arguments.format = format;
  }
  if (num_given > 1) throw ConfigError("give one log only: LOG, --rawlog, --carmen, --nist or --demo");
  if (num_given == 0) throw ConfigError("no log given: LOG, --rawlog, --carmen, --nist or --demo; see --help");
  if (source.demo) arguments.log_path = demo_log_path();
}

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
  add("--save-state", arguments.state_path,
      "what was aligned, as soon as it is, so that a run that was cut short can be resumed; example: --save-state "
      "run.state");
  app.add_flag("--resume", arguments.resume, "go on from the file that --save-state names")->group("Output");
  app.add_flag("--force", arguments.force, "replace outputs that exist")->group("Output");
}

void check_out(const MapArguments& arguments) {
  if (arguments.map_path.empty()) throw ConfigError("no map asked for; give --out map.png, .pgm or .tif");
  check_map_path("--out", arguments.map_path);
  if (!arguments.motions_path.empty() && arguments.settings.mapping.chain.method != Method::kRobust) {
    throw ConfigError("--motions needs --method robust: the paper's method has no covariances");
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
  Source source;
  std::string config_path;
  bool strict_paper = false;
  bool quiet = false;
  bool verbose = false;
  const OptionTable table = option_table(arguments.settings);

  CLI::App app("A 2D map from laser scans alone, without odometry.", "shapemap-cli");
  app.footer(kExamples + exit_code_help());
  app.set_version_flag("--version", version_text(), "print versions and exit");
  add_source(app, source);
  add_outputs(app, arguments);
  CLI::Option* quiet_flag = app.add_flag("--quiet", quiet, "print errors only");
  app.add_flag("--verbose", verbose, "print what the log holds, times, and all positions without a place")
      ->excludes(quiet_flag);
  app.add_option("--config", config_path, "options file; what is typed wins over it; example: --config options.toml")
      ->option_text("FILE.toml");
  app.add_flag("--dump-config", arguments.dump_config, "print the options file for what is in effect, and exit");
  app.add_flag("--strict-paper", strict_paper,
               "start from the paper's literal readings instead of the better settings");
  const TableFlags flags(app, table);
  if (!parse(app, typed)) return std::nullopt;

  if (strict_paper) make_strict_paper(arguments.settings.mapping);
  if (!config_path.empty()) apply_options_file(table, config_path);
  flags.apply();
  validate_all(arguments.settings.mapping);
  if (verbose) arguments.verbosity = Verbosity::kVerbose;
  if (quiet) arguments.verbosity = Verbosity::kQuiet;
  if (arguments.dump_config) return arguments;
  take_source(source, arguments);
  check_out(arguments);
  return arguments;
}

}  // namespace shapemap::cli
