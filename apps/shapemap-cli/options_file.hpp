// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "option_table.hpp"

/// Options files are TOML with one flat table: `name = value` lines and comments.
///
/// The reader of CLI11 2.1 is not used: it cuts a string at '#' and at commas, skips lines it does not understand and
/// short ones, and takes a number where a string is meant; a file of options must mean what it says or be refused.
namespace shapemap::cli {

/// Sets the options that the file names. Throws ConfigError, which names file, line and key, for a key that does not
/// exist or comes twice, for a bad value, and when the file cannot be read.
void apply_options_file(const OptionTable& table, const std::string& path);

/// Returns the file that sets every option of `table` to its present value.
std::string options_file_text(const OptionTable& table);

}  // namespace shapemap::cli
