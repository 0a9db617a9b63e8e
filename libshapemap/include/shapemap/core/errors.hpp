// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>

/// The library throws no other exceptions on purpose. Each message is one line that a user can act on: it names the
/// file and the line or offset, what was found and what was expected.
namespace shapemap {

struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A log or another input file is missing, unreadable or malformed.
struct InputError : Error {
  using Error::Error;
};

/// An option is out of its range, or options contradict each other.
struct ConfigError : Error {
  using Error::Error;
};

/// A result cannot be written.
struct OutputError : Error {
  using Error::Error;
};

/// The observer asked the run to stop.
struct Interrupted : Error {
  Interrupted() : Error("interrupted") {}
};

}  // namespace shapemap
