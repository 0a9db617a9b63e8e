// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <exception>
#include <new>

#include "commands.hpp"
#include "console.hpp"
#include "exit_codes.hpp"
#include "shapemap/core/errors.hpp"
#include "signals.hpp"

namespace {

int fail(int exit_code, const char* message) {
  std::fprintf(stderr, "shapemap-cli: %s\n", shapemap::cli::printable(message).c_str());
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  namespace cli = shapemap::cli;
  try {
    cli::install_signal_handlers();
    return cli::run_command_line({argv + (argc > 0 ? 1 : 0), argv + argc});
  } catch (const shapemap::ConfigError& e) {
    return fail(cli::kExitUsage, e.what());
  } catch (const shapemap::InputError& e) {
    return fail(cli::kExitInput, e.what());
  } catch (const shapemap::OutputError& e) {
    return fail(cli::kExitOutput, e.what());
  } catch (const shapemap::Interrupted&) {
    return fail(cli::kExitInterrupted, "interrupted; nothing written");
  } catch (const std::bad_alloc&) {
    return fail(cli::kExitUnexpected, "out of memory; nothing written");
  } catch (const std::exception& e) {
    return fail(cli::kExitUnexpected, e.what());
  }
}
