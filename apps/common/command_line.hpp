// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "option_table.hpp"
#include "shapemap/io/log_file.hpp"

/// All commands use CLI11 through these functions.
namespace shapemap::cli {

/// Makes the options of `table` flags of `app`. Typed values are kept aside, so that the options file can come first.
class TableFlags {
 public:
  TableFlags(CLI::App& app, const OptionTable& table);
  /// Sets the typed values. Throws ConfigError.
  void apply() const;

 private:
  struct Flag {
    const OptionEntry* entry;
    const CLI::Option* option;
  };
  std::vector<Flag> flags_;
};

/// Holds the text of a format option until it is parsed.
struct FormatText {
  std::string text = "auto";

  void add(CLI::App& app, const char* name, const std::string& help);
  LogFormat format(const char* name) const;
};

/// Returns false when help or the version was asked for and has been printed. Throws ConfigError for wrong usage.
bool parse(CLI::App& app, const std::vector<std::string>& arguments);

/// Returns the last lines of the help, which all commands share.
std::string exit_code_help();

}  // namespace shapemap::cli
