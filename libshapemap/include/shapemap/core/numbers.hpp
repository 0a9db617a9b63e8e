// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// The method's own numbers, fitted weights and tolerances alike, stand in plain structs with in-class values and one
/// static function `fields(self, visit)` that calls `visit(NumberField, member)` once per member. A room of the library
/// has one table of such structs, which its code reads; that single list feeds `shapemap-cli numbers`, the scripts that
/// fit weights and docs/numbers.md. What users may change is an option instead (core/options.hpp).
namespace shapemap {

/// What is said of a number outside C++. A member that is a PoseTolerance is shown as two numbers, whose names end in
/// `_m` and `_rad`.
struct NumberField {
  const char* name = "";    ///< as the member is called, with its unit
  const char* help = "";    ///< what the number is
  const char* reason = "";  ///< what it was fitted to, or why it is so
};

}  // namespace shapemap
