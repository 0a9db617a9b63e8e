// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace shapemap::cli {

/// The exit codes tell scripts the outcome; docs/cli.md and the help document them.
enum ExitCode : int {
  kExitOk = 0,            ///< done; a map has all scans
  kExitUnexpected = 1,    ///< a fault of the program, or no memory
  kExitUsage = 2,         ///< wrong usage or options
  kExitInput = 3,         ///< unreadable or malformed input; nothing written
  kExitIncomplete = 4,    ///< map written, but some scans not placed
  kExitOutput = 5,        ///< an output cannot be written
  kExitInterrupted = 130  ///< Ctrl-C; what was mapped by then is written, otherwise nothing
};

}  // namespace shapemap::cli
