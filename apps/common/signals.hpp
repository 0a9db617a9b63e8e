// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace shapemap::cli {

/// What Ctrl-C (SIGINT) or SIGTERM does.
enum class OnInterrupt {
  kExitAtOnce,  ///< while nothing is open that must be cleaned up
  kFinishStep,  ///< the running step looks at interrupted(); a second one leaves at once, see clean_up_in()
  kFinishAll,   ///< no more than that, any number of them: files go to their places
};

/// Also ignores SIGPIPE and SIGXFSZ, so that a closed pipe and a full disk are reported like other failed writes.
void install_signal_handlers();
void set_interrupt_policy(OnInterrupt policy);
bool interrupted();

/// A second interrupt takes away the temporary files that this process has in `folder`, and the folder itself if
/// `is_new` and nothing else is in it.
void clean_up_in(const std::string& folder, bool is_new = false);

}  // namespace shapemap::cli
