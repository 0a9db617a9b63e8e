// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace shapemap::cli {

/// What the program tells scripts; documented in docs/cli.md and in the help.
enum ExitCode : int {
  kExitOk = 0,            ///< done; of a map: all positions placed
  kExitUnexpected = 1,    ///< a fault of the program, or no memory
  kExitUsage = 2,         ///< wrong usage or options
  kExitInput = 3,         ///< unreadable or malformed input; nothing written
  kExitIncomplete = 4,    ///< map written, some positions not placed
  kExitOutput = 5,        ///< cannot write
  kExitInterrupted = 130  ///< Ctrl-C; a map of what was mapped by then is written, else nothing
};

}  // namespace shapemap::cli
