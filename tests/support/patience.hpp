// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "shapemap/mapper/mapping_events.hpp"

namespace shapemap::test {

/// This observer lets a run go on until it has been asked `times` times.
struct Patience : MappingEvents {
  explicit Patience(std::size_t times) : left(times) {}
  bool keep_going() override {
    ++asked;
    if (left > 0) --left;
    return left > 0;
  }
  std::size_t left;
  std::size_t asked = 0;
};

}  // namespace shapemap::test
