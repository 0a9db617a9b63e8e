// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>
#include <string_view>
#include <type_traits>

#include "shapemap/core/angles.hpp"
#include "shapemap/core/errors.hpp"

/// Options are plain structs with in-class defaults and one static function `fields(self, visit)` that calls
/// `visit(Field, member)` once per member. That single list feeds the command line, the options file,
/// validation, the report and the docs.
namespace shapemap {

/// A field says what users see of an option. The limits and the name are in the unit of the name: an angle is called
/// `...-deg`, has `unit = kDegree` and is stored in radians.
struct Field {
  const char* name = "";
  const char* help = "";
  double lowest = 0.0;        ///< the limit is inclusive; it is ignored for bool and enum
  double highest = 0.0;       ///< the limit is inclusive
  double unit = 1.0;          ///< the stored value is the shown value times this
  const char* old_name = "";  ///< a name that the option had before, and that is still accepted

  /// Returns the same field with a name that it had before.
  constexpr Field formerly(const char* name_before) const {
    Field field = *this;
    field.old_name = name_before;
    return field;
  }
};

/// The spellings of an enumeration stand in the order of its values from 0; specialise as `template <> struct
/// EnumNames<E> { static constexpr std::array<std::string_view, n> names{...}; };`
template <class Enum>
struct EnumNames;

template <class Enum>
std::string enum_name(Enum value) {
  return std::string(EnumNames<Enum>::names.at(static_cast<std::size_t>(value)));
}

/// Throws ConfigError, which names the spellings that exist, when `name` is none of them.
template <class Enum>
Enum enum_from_name(std::string_view name) {
  std::string known;
  for (std::size_t i = 0; i < EnumNames<Enum>::names.size(); ++i) {
    if (EnumNames<Enum>::names[i] == name) return static_cast<Enum>(i);
    known += (i ? ", " : "") + std::string(EnumNames<Enum>::names[i]);
  }
  throw ConfigError("'" + std::string(name) + "' is not one of: " + known);
}

/// Throws ConfigError when a number of `options` is out of its limits or not a number.
template <class Options>
void validate(const Options& options) {
  Options::fields(options, [](const Field& field, const auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (!std::is_same_v<Value, bool> && std::is_arithmetic_v<Value>) {
      const double shown = static_cast<double>(value) / field.unit;
      const auto slack = [](double limit) { return 1e-9 * std::abs(limit); };  // conversion of units rounds
      const bool inside = field.lowest - slack(field.lowest) <= shown && shown <= field.highest + slack(field.highest);
      if (inside) return;  // the comparison is written so that NaN fails
      std::ostringstream why;
      why << "--" << field.name << " is " << shown << ", expected " << field.lowest << " to " << field.highest;
      throw ConfigError(why.str());
    }
  });
}

}  // namespace shapemap
