// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "option_table.hpp"
#include "shapemap/io/log_file.hpp"

/// CLI11 as all commands use it.
namespace shapemap::cli {

/// The options of `table` as flags of `app`. What is typed is kept aside, so that the options file can come first.
class TableFlags {
 public:
  TableFlags(CLI::App& app, const OptionTable& table);
  /// Sets what was typed. Throws ConfigError.
  void apply() const;

 private:
  struct Flag {
    const OptionEntry* entry;
    const CLI::Option* option;
  };
  std::vector<Flag> flags_;
};

/// Holds a format option's text until it is looked at.
struct FormatText {
  std::string text = "auto";

  void add(CLI::App& app, const char* name, const std::string& help);
  LogFormat format(const char* name) const;
};

/// False when help or the version was asked for; it has been printed then. Throws ConfigError for wrong usage.
bool parse(CLI::App& app, const std::vector<std::string>& arguments);

/// The help's last lines that all commands share.
std::string exit_code_help();

}  // namespace shapemap::cli
