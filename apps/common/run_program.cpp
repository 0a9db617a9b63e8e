// SPDX-License-Identifier: GPL-3.0-or-later
#include "run_program.hpp"

#include <cstdio>
#include <exception>
#include <new>

#include "console.hpp"
#include "exit_codes.hpp"
#include "shapemap/core/errors.hpp"
#include "signals.hpp"

namespace shapemap::cli {
namespace {

int fail(int exit_code, const char* message) {
  std::fprintf(stderr, "%s: %s\n", kProgramName, printable(message).c_str());
  return exit_code;
}

}  // namespace

int run_program(int argc, char** argv, int (*run)(const std::vector<std::string>& typed)) {
  try {
    install_signal_handlers();
    return run({argv + (argc > 0 ? 1 : 0), argv + argc});
  } catch (const ConfigError& e) {
    return fail(kExitUsage, e.what());
  } catch (const InputError& e) {
    return fail(kExitInput, e.what());
  } catch (const OutputError& e) {
    return fail(kExitOutput, e.what());
  } catch (const Interrupted&) {
    return fail(kExitInterrupted, "interrupted; nothing written");
  } catch (const std::bad_alloc&) {
    return fail(kExitUnexpected, "out of memory; nothing written");
  } catch (const std::exception& e) {
    return fail(kExitUnexpected, e.what());
  }
}

}  // namespace shapemap::cli
