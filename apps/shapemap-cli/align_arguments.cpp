// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <iterator>

#include "arguments.hpp"
#include "command_line.hpp"
#include "options_file.hpp"

namespace shapemap::cli {
namespace {

constexpr const char* kExamples =
    "FILE of pairs: lines 'i j' or 'i j x_m y_m theta_rad'; '#' begins a remark. i and j count the positions that\n"
    "--skip, --every and --first leave, from 0; with OTHER, j counts in OTHER.\n\n"
    "Examples:\n"
    "  shapemap-cli align intel.log.gz --gap 1 --out pairs.jsonl\n"
    "  shapemap-cli align monday.log tuesday.log --pairs pairs.txt --threads 4 --out -\n\n";

/// Says whether matching two scans depends on the option.
bool matters(const OptionEntry& entry) {
  const auto begins_with = [&](const char* text) { return entry.group.rfind(text, 0) == 0; };
  if (entry.group == "Run") return entry.name == "threads";
  return !begins_with("Paper's method") && entry.group != "Robust method: chain" && entry.group != "Map" &&
         entry.group != "Drawing";
}

void add_pair_options(CLI::App& app, AlignArguments& arguments, std::string& gap) {
  app.add_option("--gap", gap, "align each position to the one so many before it; example: --gap 1")
      ->option_text("N")
      ->group("Pairs");
  app.add_option("--pairs", arguments.pairs_path, "align the pairs that a file lists; example: --pairs pairs.txt")
      ->option_text("FILE")
      ->group("Pairs");
  app.add_option("--out", arguments.out_path,
                 "one JSON object a line, '-' for standard output; example: --out pairs.jsonl")
      ->option_text("FILE")
      ->group("Output");
  app.add_flag("--force", arguments.force, "replace FILE if it exists")->group("Output");
  app.add_flag("--timings", arguments.timings, "with the seconds that each pair took")->group("Output");
  app.add_flag("--quiet", arguments.quiet, "print errors only");
}

void check_pairs(const AlignArguments& arguments) {
  if (arguments.log_path.empty()) throw ConfigError("no log given; see 'shapemap-cli align --help'");
  if ((arguments.gap > 0) == !arguments.pairs_path.empty()) throw ConfigError("give one of --gap and --pairs");
  if (arguments.gap > 0 && !arguments.other_path.empty()) {
    throw ConfigError("--gap is for positions of one log; give --pairs with two");
  }
  if (arguments.out_path.empty()) throw ConfigError("no output given; give --out FILE, or --out - for standard output");
}

}  // namespace

OptionTable align_option_table(MapSettings& settings) {
  const OptionTable all = option_table(settings);
  OptionTable table;
  std::copy_if(all.begin(), all.end(), std::back_inserter(table), matters);
  return table;
}

std::optional<AlignArguments> parse_align_arguments(const std::vector<std::string>& typed) {
  AlignArguments arguments;
  FormatText from;
  std::string gap;
  const OptionTable table = align_option_table(arguments.settings);

  CLI::App app("Aligns pairs of positions by the robust method, each pair by itself, and writes what was found.",
               "shapemap-cli align");
  app.footer(kExamples + exit_code_help());
  app.add_option("LOG", arguments.log_path, "log of the reference positions")->option_text(" ");
  app.add_option("OTHER", arguments.other_path, "log of the query positions; without it, LOG")->option_text(" ");
  from.add(app, "--from", "format of the logs; auto: by their content; example: --from carmen");
  add_pair_options(app, arguments, gap);
  app.add_option("--config", arguments.config_path,
                 "options file; what is typed wins over it; example: --config options.toml")
      ->option_text("FILE.toml");
  app.add_flag("--dump-config", arguments.dump_config, "print the options file for what is in effect, and exit");
  const TableFlags flags(app, table);
  if (!parse(app, typed)) return std::nullopt;

  if (!arguments.config_path.empty()) apply_options_file(option_table(arguments.settings), arguments.config_path);
  flags.apply();
  validate_all(arguments.settings.mapping);
  arguments.format = from.format("from");
  if (!gap.empty()) arguments.gap = parse_integer(Field{"gap", "", 1, 2147483647}, gap);
  if (!arguments.dump_config) check_pairs(arguments);
  return arguments;
}

}  // namespace shapemap::cli
