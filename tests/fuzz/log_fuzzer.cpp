// SPDX-License-Identifier: GPL-3.0-or-later
// For libFuzzer: build with clang and -DSHAPEMAP_FUZZ=ON, and give a folder of small logs to begin with.
#include <cstddef>
#include <cstdint>

#include "support/hostile_log.hpp"
#include "support/temp_folder.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const shapemap::test::TempFolder folder;
  shapemap::test::read_and_map(folder.write("fuzzed.log", {reinterpret_cast<const char*>(data), size}));
  return 0;
}
