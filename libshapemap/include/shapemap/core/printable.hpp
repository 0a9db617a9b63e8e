// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// Text that comes from files and users reaches a terminal, or a message that may reach one, only through printable().
namespace shapemap {

/// A line that is shown has at most so many bytes, since a longer name says nothing more.
inline constexpr std::size_t kMostShown = 1000;
/// A name within a line has at most so many bytes.
inline constexpr std::size_t kMostNameShown = 100;

/// Returns `text` as one line of valid UTF-8 that does nothing to a terminal: each byte of control characters (C0, DEL,
/// C1), line separators, marks of writing direction and invalid UTF-8 becomes `\xNN`. A text longer than `most` bytes
/// loses its middle, since both ends of a message say what is wrong.
std::string printable(std::string_view text, std::size_t most = kMostShown);

}  // namespace shapemap
