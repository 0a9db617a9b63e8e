// SPDX-License-Identifier: GPL-3.0-or-later
#include "saved_state.hpp"

#include <filesystem>

#include "console.hpp"
#include "map_outputs.hpp"

namespace shapemap::cli {
namespace {

namespace fs = std::filesystem;

}  // namespace

void check_state(const MapArguments& arguments) {
  const std::string& path = arguments.state_path;
  if (path.empty()) {
    if (arguments.resume) throw ConfigError("--resume needs --save-state FILE, the file to go on from");
    return;
  }
  if (arguments.settings.mapping.run.method != Method::kRobust) {
    throw ConfigError("--save-state needs --method robust: the paper's method keeps nothing");
  }
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  const bool is_stream = fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
  if (path == "-" || is_stream) throw OutputError("cannot write '" + path + "': the state needs a file");
  std::vector<std::string> paths = output_paths(arguments);
  paths.push_back(path);
  for (const std::string& input : input_paths(arguments)) check_distinct(paths, input);
  if (arguments.resume) {
    if (!fs::exists(status)) throw InputError("there is no state '" + path + "' to resume");
    return;
  }
  if (fs::is_regular_file(status) && !arguments.force) {
    throw OutputError("'" + path + "' exists already; --resume goes on from it, --force begins anew");
  }
  for (const std::string& input : input_paths(arguments)) check_outputs({path}, input, arguments.force);
}

std::unique_ptr<MatchCacheFile> open_state(const MapArguments& arguments, const Log& log,
                                           std::vector<std::string>& warnings) {
  if (arguments.state_path.empty()) return nullptr;
  StateOpening opening = arguments.force ? StateOpening::kReplace : StateOpening::kCreate;
  if (arguments.resume) opening = StateOpening::kResume;
  auto state = std::make_unique<MatchCacheFile>(arguments.state_path, opening, log, arguments.settings.mapping);
  if (!state->warning().empty()) warnings.push_back(state->warning());
  return state;
}

void print_resumed(const MapArguments& arguments, const MatchCacheFile* state) {
  if (!state || !arguments.resume || arguments.verbosity == Verbosity::kQuiet) return;
  print_line("resumed '" + arguments.state_path + "' with " + std::to_string(state->num_resumed()) + " alignments");
}

}  // namespace shapemap::cli
