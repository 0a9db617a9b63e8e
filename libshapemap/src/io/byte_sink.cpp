// SPDX-License-Identifier: GPL-3.0-or-later
#include "byte_sink.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "shapemap/core/errors.hpp"

namespace shapemap {
namespace {

constexpr std::size_t kLargestChunk = 1U << 20U;  // zlib counts in unsigned int

std::string reason() { return errno != 0 ? std::strerror(errno) : "compression failed"; }

}  // namespace

ByteSink::ByteSink(const std::string& path, Compression compression) : path_(path), file_(path) {
  errno = 0;
  stream_ = gzopen(file_.temporary_path().c_str(), compression == Compression::kGzip ? "wb" : "wbT");
  if (stream_ == nullptr) throw OutputError(path_ + ": cannot be written: " + reason());
}

ByteSink::~ByteSink() {
  if (stream_ != nullptr) gzclose(stream_);
}

void ByteSink::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::size_t count = std::min(bytes.size(), kLargestChunk);
    errno = 0;
    if (gzwrite(stream_, bytes.data(), static_cast<unsigned>(count)) != static_cast<int>(count)) {
      throw OutputError(path_ + ": cannot be written: " + reason());
    }
    bytes.remove_prefix(count);
  }
}

void ByteSink::commit() {
  errno = 0;
  const int status = gzclose(stream_);
  stream_ = nullptr;
  if (status != Z_OK) throw OutputError(path_ + ": cannot be written: " + reason());
  file_.commit();
}

}  // namespace shapemap
