// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace shapemap::cli {

/// The policy decides what Ctrl-C (SIGINT) or SIGTERM does.
enum class OnInterrupt {
  kExitAtOnce,  ///< for the time in which nothing is open that must be cleaned up
  kFinishStep,  ///< the running step checks interrupted(); a second one leaves at once, see clean_up_in()
  kFinishAll,   ///< any number of interrupts only sets interrupted(), while files move to their places
};

/// Also ignores SIGPIPE and SIGXFSZ, so that a closed pipe and a full disk are reported like other failed writes.
void install_signal_handlers();
void set_interrupt_policy(OnInterrupt policy);
bool interrupted();

/// Makes a second interrupt remove the temporary files that this process has in `folder`, and the folder itself if
/// `is_new` and nothing else is in it.
void clean_up_in(const std::string& folder, bool is_new = false);

}  // namespace shapemap::cli
