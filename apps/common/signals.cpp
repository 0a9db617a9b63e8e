// SPDX-License-Identifier: GPL-3.0-or-later
#include "signals.hpp"

#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <map>
#include <mutex>
#include <system_error>
#include <thread>

#include "exit_codes.hpp"
#include "leftovers.hpp"
#include "run_program.hpp"

namespace shapemap::cli {
namespace {

// A signal handler may use only globals of this type.
volatile std::sig_atomic_t policy_now = static_cast<int>(OnInterrupt::kExitAtOnce);
volatile std::sig_atomic_t was_interrupted = 0;
volatile std::sig_atomic_t wake_cleaner = -1;  ///< a write to this descriptor removes the leftovers; -1: there are none

/// Cleaning up takes much less; if it never ends, work goes on rather than hang.
constexpr int kCleaning_ms = 5000;

[[noreturn]] void leave() {
  for (const char* part : {kProgramName, ": interrupted; nothing written\n"}) {
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, part, std::strlen(part));
  }
  ::_exit(kExitInterrupted);
}

extern "C" void on_interrupt(int /*signal*/) {
  const bool is_first = was_interrupted == 0;
  was_interrupted = 1;
  if (policy_now == static_cast<int>(OnInterrupt::kExitAtOnce)) leave();
  if (is_first || policy_now == static_cast<int>(OnInterrupt::kFinishAll)) return;
  if (wake_cleaner < 0) leave();
  const int error = errno;
  [[maybe_unused]] const ssize_t written = ::write(static_cast<int>(wake_cleaner), "x", 1);
  ::poll(nullptr, 0, kCleaning_ms);  // this thread makes no more files meanwhile; the end of the process comes first
  errno = error;
}

void handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

/// A second interrupt searches these folders. They live as long as the process, which may end at any moment.
struct Leftovers {
  std::mutex mutex;
  std::map<std::string, bool> folders;  ///< maps each folder to whether it is new
};

Leftovers& leftovers() {
  static auto* const all = new Leftovers;
  return *all;
}

void clean_up_when_woken(int read_end) {
  char byte = 0;
  if (::read(read_end, &byte, 1) != 1) return;
  const std::lock_guard<std::mutex> lock(leftovers().mutex);
  for (const auto& [folder, is_new] : leftovers().folders) {
    remove_temporary_files(folder);
    if (is_new) ::rmdir(folder.c_str());
  }
  leave();
}

/// A signal handler cannot list folders; this thread does it, and takes no signals itself.
void start_cleaner() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return;
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  try {
    std::thread(clean_up_when_woken, ends[0]).detach();
    wake_cleaner = ends[1];
  } catch (const std::system_error&) {  // without a thread, a second interrupt leaves the files
    ::close(ends[0]);
    ::close(ends[1]);
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

}  // namespace

void install_signal_handlers() {
  // SA_RESTART is not set, so that an interrupt ends the wait for the reader of a pipe.
  for (const int signal : {SIGINT, SIGTERM}) handle(signal, on_interrupt);
  for (const int signal : {SIGPIPE, SIGXFSZ}) handle(signal, SIG_IGN);
}

void set_interrupt_policy(OnInterrupt policy) { policy_now = static_cast<int>(policy); }

bool interrupted() { return was_interrupted != 0; }

void clean_up_in(const std::string& folder, bool is_new) {
  const std::lock_guard<std::mutex> lock(leftovers().mutex);
  leftovers().folders[folder] |= is_new;
  if (wake_cleaner < 0) start_cleaner();
}

}  // namespace shapemap::cli
