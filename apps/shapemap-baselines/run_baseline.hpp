// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "arguments.hpp"

namespace shapemap::baselines {

std::unique_ptr<SlamMethod> make_method(BaselineMethod method, const BaselineSettings& settings);

/// Runs the whole program and returns the exit code; all failures are exceptions.
int run_command_line(const std::vector<std::string>& typed);

}  // namespace shapemap::baselines
