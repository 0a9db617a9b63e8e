// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace shapemap::cli {

/// What the first Ctrl-C (SIGINT) or SIGTERM does; a second one always kills.
enum class OnInterrupt {
  kExitAtOnce,  ///< while nothing is open that must be cleaned up
  kFinishStep,  ///< the running step looks at interrupted()
};

/// Also ignores SIGPIPE and SIGXFSZ, so that a closed pipe and a full disk are reported like other failed writes.
void install_signal_handlers();
void set_interrupt_policy(OnInterrupt policy);
bool interrupted();

}  // namespace shapemap::cli
