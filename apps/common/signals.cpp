// SPDX-License-Identifier: GPL-3.0-or-later
#include "signals.hpp"

#include <unistd.h>

#include <csignal>
#include <cstring>

#include "exit_codes.hpp"
#include "run_program.hpp"

namespace shapemap::cli {
namespace {

// A signal handler reaches nothing but globals of this type.
volatile std::sig_atomic_t exit_at_once = 1;
volatile std::sig_atomic_t was_interrupted = 0;

extern "C" void on_interrupt(int /*signal*/) {
  was_interrupted = 1;
  if (exit_at_once == 0) return;
  for (const char* part : {kProgramName, ": interrupted; nothing written\n"}) {
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, part, std::strlen(part));
  }
  ::_exit(kExitInterrupted);
}

void handle(int signal, void (*handler)(int), int flags) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

}  // namespace

void install_signal_handlers() {
  // SA_RESETHAND: the second signal meets the system's own handler, which kills. No SA_RESTART: waiting for the reader
  // of a pipe ends.
  for (const int signal : {SIGINT, SIGTERM}) handle(signal, on_interrupt, static_cast<int>(SA_RESETHAND));
  for (const int signal : {SIGPIPE, SIGXFSZ}) handle(signal, SIG_IGN, 0);
}

void set_interrupt_policy(OnInterrupt policy) { exit_at_once = policy == OnInterrupt::kExitAtOnce ? 1 : 0; }

bool interrupted() { return was_interrupted != 0; }

}  // namespace shapemap::cli
