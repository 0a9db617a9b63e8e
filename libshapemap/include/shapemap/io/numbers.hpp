// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

/// The method's own numbers, for people and for the scripts that fit them.
namespace shapemap {

/// A fitted weight, a tolerance or another number that the code of a room reads from its table.
struct MethodNumber {
  std::string room;       ///< of the library, such as "matching"
  std::string group;      ///< what it is for, as the room's table names it
  std::string title;      ///< the same for people
  std::string name;       ///< with its unit, as `_m` or `_rad`
  double value = 0.0;     ///< angles are radians
  bool is_whole = false;  ///< it counts something
  std::string help;       ///< what it is
  std::string reason;     ///< what it was fitted to, or why it is so
};

/// All numbers of all rooms, in the order of the rooms.
std::vector<MethodNumber> method_numbers();

/// The same as a JSON array with an object for each number: room, group, title, name, value, help and fitted_to.
std::string method_numbers_json();

}  // namespace shapemap
