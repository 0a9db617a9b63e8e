// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line.hpp"

#include <algorithm>

#include "console.hpp"

namespace shapemap::cli {
namespace {

const char* value_name(OptionEntry::Kind kind) {
  switch (kind) {
    case OptionEntry::Kind::kNumber:
      return "NUMBER";
    case OptionEntry::Kind::kInteger:
      return "N";
    case OptionEntry::Kind::kChoice:
      return "CHOICE";
    case OptionEntry::Kind::kText:
      return "TEXT";
    case OptionEntry::Kind::kSwitch:
      return "";
  }
  return "";
}

/// Returns meaning, limits, and the default in the way it would be typed.
std::string description_of(const OptionEntry& entry) {
  const std::string value = entry.text();
  std::string typed = "--" + entry.name;
  if (entry.kind == OptionEntry::Kind::kSwitch) {
    if (value == "false") typed = "--no-" + entry.name;
  } else {
    typed += value.empty() ? " ''" : " " + value;
  }
  return entry.help + " (" + (entry.allowed.empty() ? "" : entry.allowed + "; ") + "default: " + typed + ")";
}

CLI::Option* add_flag(CLI::App& app, const OptionEntry& entry, const std::string& name) {
  const std::string description = description_of(entry);
  if (entry.kind == OptionEntry::Kind::kSwitch) return app.add_flag("--" + name + ",!--no-" + name, description);
  CLI::Option* option = app.add_option(
      "--" + name, [](const CLI::results_t&) { return true; }, description);
  return option->option_text(value_name(entry.kind));
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

}  // namespace

TableFlags::TableFlags(CLI::App& app, const OptionTable& table) {
  constexpr const char* kHidden = "";
  for (const OptionEntry& entry : table) {
    CLI::Option* const now = add_flag(app, entry, entry.name)->group(entry.group);
    flags_.push_back({&entry, now});
    if (entry.old_name.empty()) continue;
    flags_.push_back({&entry, add_flag(app, entry, entry.old_name)->group(kHidden)->excludes(now)});
  }
}

void TableFlags::apply() const {
  for (const Flag& flag : flags_) {
    if (flag.option->count() > 0) flag.entry->set(flag.option->results().back());
  }
}

void FormatText::add(CLI::App& app, const char* name, const std::string& help) {
  app.add_option(name, text, help + " (" + spellings_text<LogFormat>() + ")")->option_text("FORMAT");
}

LogFormat FormatText::format(const char* name) const { return parse_choice<LogFormat>(Field{name, ""}, text); }

bool parse(CLI::App& app, const std::vector<std::string>& arguments) {
  std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());  // CLI11 wants this order
  try {
    app.parse(reversed);
  } catch (const CLI::CallForVersion& e) {
    print_text(std::string(e.what()) + "\n");
    return false;
  } catch (const CLI::Success&) {
    print_text(app.help());
    return false;
  } catch (const CLI::ParseError& e) {
    throw ConfigError(one_line(e.what()) + "; see '" + app.get_name() + " --help'");
  }
  return true;
}

std::string exit_code_help() {
  return "Exit codes: 0 done, a map has all positions; 1 unexpected failure; 2 wrong usage; 3 unreadable or malformed "
         "input,\n"
         "nothing written; 4 map written, some positions not placed; 5 cannot write; 130 interrupted: of a map,\n"
         "what was mapped by then is written.";
}

}  // namespace shapemap::cli
