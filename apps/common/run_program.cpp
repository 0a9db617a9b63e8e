// SPDX-License-Identifier: GPL-3.0-or-later
#include "run_program.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <exception>
#include <new>

#include "console.hpp"
#include "exit_codes.hpp"
#include "shapemap/core/errors.hpp"
#include "signals.hpp"

namespace shapemap::cli {
namespace {

/// Occupies closed standard descriptors: a file opened later would get such a number, and be overwritten with text for
/// a terminal. They are opened the wrong way round, so that writing to a closed standard output still fails.
void occupy_standard_descriptors() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) continue;
    const int flags = descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY;
    if (::open("/dev/null", flags) == -1) std::abort();  // there is nobody to tell
  }
}

int fail(int exit_code, const char* message) {
  print_line(message);
  return exit_code;
}

}  // namespace

int run_program(int argc, char** argv, int (*run)(const std::vector<std::string>& typed)) {
  occupy_standard_descriptors();
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
