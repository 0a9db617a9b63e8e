// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <zlib.h>

#include <string>
#include <string_view>

#include "shapemap/io/atomic_file.hpp"

namespace shapemap {

/// A file that is written in chunks, gzip-compressed or not, and appears whole or not at all.
class ByteSink {
 public:
  enum class Compression { kNone, kGzip };

  /// Throws OutputError, as all functions here do.
  ByteSink(const std::string& path, Compression compression);
  ~ByteSink();
  ByteSink(const ByteSink&) = delete;
  ByteSink& operator=(const ByteSink&) = delete;

  void write(std::string_view bytes);
  void commit();

 private:
  std::string path_;
  AtomicFile file_;
  gzFile stream_ = nullptr;
};

}  // namespace shapemap
