// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "arguments.hpp"

namespace shapemap::cli {

/// These flags name the logs to map. They must outlive the parsing.
class LogSourceFlags {
 public:
  void add(CLI::App& app);
  /// Returns the logs in the order in which they were typed. Throws ConfigError when there is none, or one twice.
  std::vector<LogSource> take(const CLI::App& app, const std::vector<std::string>& typed) const;

 private:
  struct Kind {
    const CLI::Option* option;
    LogFormat format;
  };
  std::vector<Kind> kinds_;
  bool demo_ = false;
};

}  // namespace shapemap::cli
