// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// The only way of text that files and users give to a terminal, or into a message that may reach one.
namespace shapemap {

/// Of one line that is shown. A name that is longer says nothing more.
inline constexpr std::size_t kMostShown = 1000;
/// Of a name within a line.
inline constexpr std::size_t kMostNameShown = 100;

/// `text` as one line of valid UTF-8 that does nothing to a terminal: control characters (C0, DEL, C1), separators of
/// lines, marks that change the direction of writing and bytes that are no UTF-8 become `\xNN`, one for each byte. What
/// is longer than `most` bytes loses its middle, since both ends of a message say what is wrong.
std::string printable(std::string_view text, std::size_t most = kMostShown);

}  // namespace shapemap
