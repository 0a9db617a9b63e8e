// SPDX-License-Identifier: GPL-3.0-or-later
#include "log_source_flags.hpp"

#include <algorithm>
#include <map>

#include "demo_log.hpp"
#include "output_set.hpp"

namespace shapemap::cli {
namespace {

CLI::Option* add_paths(CLI::App& app, const char* name, const char* help) {
  return app
      .add_option(
          name, [](const CLI::results_t&) { return true; }, help)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->option_text("LOG")
      ->group("Input");
}

void check_no_file_twice(const std::vector<LogSource>& logs) {
  for (std::size_t i = 0; i < logs.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!same_file(logs[i].path, logs[j].path)) continue;
      const bool is_link = logs[i].path != logs[j].path;
      throw ConfigError("'" + logs[i].path + "' is given twice" + (is_link ? ", also as '" + logs[j].path + "'" : ""));
    }
  }
}

}  // namespace

void LogSourceFlags::add(CLI::App& app) {
  CLI::Option* any =
      add_paths(app, "LOG", "log to map, or several for one map; formats are recognised from the content");
  kinds_.push_back({any->expected(-1)->allow_extra_args()->option_text(" "), LogFormat::kAuto});
  kinds_.push_back(
      {add_paths(app, "--rawlog", "an MRPT rawlog, plain or gzip; example: --rawlog run.rawlog"), LogFormat::kRawlog});
  kinds_.push_back(
      {add_paths(app, "--carmen", "a CARMEN log, plain or gzip; example: --carmen intel.log.gz"), LogFormat::kCarmen});
  kinds_.push_back(
      {add_paths(app, "--nist", "a NIST text log or bare numbers; example: --nist arena.nist"), LogFormat::kNist});
  app.add_flag("--demo", demo_, "map the log that comes with shapemap; example: --demo --out map.png")->group("Input");
}

std::vector<LogSource> LogSourceFlags::take(const CLI::App& app, const std::vector<std::string>& typed) const {
  std::vector<LogSource> logs;
  std::map<const CLI::Option*, std::size_t> num_taken;
  for (const CLI::Option* option : app.parse_order()) {
    const auto kind = std::find_if(kinds_.begin(), kinds_.end(), [&](const Kind& k) { return k.option == option; });
    if (kind == kinds_.end()) continue;
    logs.push_back({option->results().at(num_taken[option]++), kind->format});
  }
  if (demo_ && !logs.empty()) throw ConfigError("give logs or --demo, not both");
  if (demo_) return {{demo_log_path(), LogFormat::kAuto}};
  if (logs.empty()) throw ConfigError("no log given: LOG, --rawlog, --carmen, --nist or --demo; see --help");
  for (const LogSource& log : logs) {
    if (std::find(typed.begin(), typed.end(), log.path) != typed.end() || log.format != LogFormat::kAuto) continue;
    throw ConfigError("a log whose name is in brackets is given as './[...]'");  // CLI11 takes it for a list
  }
  check_no_file_twice(logs);
  return logs;
}

}  // namespace shapemap::cli
