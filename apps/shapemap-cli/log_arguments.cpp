// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "arguments.hpp"
#include "command_line.hpp"

namespace shapemap::cli {
namespace {

bool ends_in(const std::string& text, const std::string& ending) {
  return text.size() > ending.size() && text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

LogFormat format_by_ending(std::string path) {
  std::transform(path.begin(), path.end(), path.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (ends_in(path, ".gz")) path.resize(path.size() - 3);
  const std::array<std::pair<const char*, LogFormat>, 5> endings{{{".rawlog", LogFormat::kRawlog},
                                                                  {".log", LogFormat::kCarmen},
                                                                  {".clf", LogFormat::kCarmen},
                                                                  {".nist", LogFormat::kNist},
                                                                  {".txt", LogFormat::kNist}}};
  for (const auto& [ending, format] : endings) {
    if (ends_in(path, ending)) return format;
  }
  throw ConfigError("the format of '" + path + "' is not clear from its ending; give --to rawlog, carmen or nist");
}

}  // namespace

std::optional<InfoArguments> parse_info_arguments(const std::vector<std::string>& typed) {
  InfoArguments arguments;
  FormatText from;
  OptionTable table;
  append_options(table, "Reading", arguments.reading);

  CLI::App app("What a laser log holds: sensors, counts, ranges, duration.", "shapemap-cli info");
  app.footer("Examples:\n  shapemap-cli info intel.log.gz\n  shapemap-cli info run.rawlog --sensor-label FRONT\n\n" +
             exit_code_help());
  app.add_option("LOG", arguments.log_path, "log to look at")->required()->option_text(" ");
  from.add(app, "--from", "format of the log; auto: by its content; example: --from carmen");
  const TableFlags flags(app, table);
  if (!parse(app, typed)) return std::nullopt;
  flags.apply();
  arguments.format = from.format("from");
  return arguments;
}

std::optional<ConvertArguments> parse_convert_arguments(const std::vector<std::string>& typed) {
  ConvertArguments arguments;
  FormatText from;
  FormatText to;
  OptionTable table;
  append_options(table, "Reading", arguments.reading);

  CLI::App app("Writes a laser log in another format.", "shapemap-cli convert");
  app.footer(
      "Endings: .rawlog; .log or .clf for CARMEN; .nist or .txt for NIST text; .gz after it compresses.\n\n"
      "Examples:\n  shapemap-cli convert run.rawlog run.log.gz\n"
      "  shapemap-cli convert readings.txt run.rawlog --fov-deg 100 --sub-scans 4\n\n" +
      exit_code_help());
  app.add_option("IN", arguments.in_path, "log to read")->required()->option_text(" ");
  app.add_option("OUT", arguments.out_path, "log to write")->required()->option_text(" ");
  from.add(app, "--from", "format of IN; auto: by its content; example: --from carmen");
  to.add(app, "--to", "format of OUT; auto: by its ending; example: --to nist");
  app.add_flag("--force", arguments.force, "replace OUT if it exists");
  const TableFlags flags(app, table);
  if (!parse(app, typed)) return std::nullopt;
  flags.apply();
  arguments.from = from.format("from");
  arguments.to = to.format("to");
  if (arguments.to == LogFormat::kAuto) arguments.to = format_by_ending(arguments.out_path);
  return arguments;
}

}  // namespace shapemap::cli
