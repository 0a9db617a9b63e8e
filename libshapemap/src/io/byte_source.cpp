// SPDX-License-Identifier: GPL-3.0-or-later
#include "byte_source.hpp"

#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "shapemap/core/errors.hpp"

namespace shapemap {
namespace {

constexpr std::size_t kChunk = 1U << 16U;
constexpr int kGzipOnly = 16 + MAX_WBITS;  // tells zlib to expect a gzip header and the largest window

bool starts_like_gzip(const char* bytes, std::size_t count) {
  return count >= 2 && bytes[0] == '\x1f' && bytes[1] == '\x8b';
}

Bytef* zlib_bytes(char* bytes) { return reinterpret_cast<Bytef*>(bytes); }

}  // namespace

ByteSource::ByteSource(std::string path) : path_(std::move(path)) {
  struct stat status {};
  if (::stat(path_.c_str(), &status) != 0) throw InputError(path_ + ": cannot be read: " + std::strerror(errno));
  if (S_ISDIR(status.st_mode)) throw InputError(path_ + ": is a directory, expected a laser log");
  file_.reset(std::fopen(path_.c_str(), "rb"));
  if (!file_) throw InputError(path_ + ": cannot be read: " + std::strerror(errno));

  compressed_.resize(kChunk);
  const std::size_t count = read_raw(compressed_.data(), kChunk);
  if (count == 0) throw InputError(path_ + ": is empty, expected a laser log");
  is_gzip_ = starts_like_gzip(compressed_.data(), count);
  if (!is_gzip_) {
    window_.assign(compressed_.begin(), compressed_.begin() + static_cast<std::ptrdiff_t>(count));
    return;
  }
  compressed_read_ = count;
  inflater_.next_in = zlib_bytes(compressed_.data());
  inflater_.avail_in = static_cast<uInt>(count);
  if (inflateInit2(&inflater_, kGzipOnly) != Z_OK) throw InputError(path_ + ": cannot start to decompress it");
}

ByteSource::~ByteSource() {
  if (is_gzip_) inflateEnd(&inflater_);
}

std::size_t ByteSource::ensure(std::size_t count) {
  while (buffered().size() < count && !ended_) {
    drop_consumed();
    if (is_gzip_) {
      fill_inflated();
    } else {
      fill();
    }
  }
  return buffered().size();
}

std::size_t ByteSource::read_raw(char* to, std::size_t count) {
  const std::size_t got = std::fread(to, 1, count, file_.get());
  if (got < count && std::ferror(file_.get())) {
    throw InputError(path_ + ": cannot be read: " + std::strerror(errno));
  }
  return got;
}

void ByteSource::drop_consumed() {
  if (begin_ < window_.size() / 2) return;  // moving less than half would cost more than it gives
  window_.erase(window_.begin(), window_.begin() + static_cast<std::ptrdiff_t>(begin_));
  consumed_before_window_ += begin_;
  begin_ = 0;
}

void ByteSource::fill() {
  const std::size_t old_size = window_.size();
  window_.resize(old_size + kChunk);
  const std::size_t count = read_raw(window_.data() + old_size, kChunk);
  window_.resize(old_size + count);
  ended_ = count == 0;
}

void ByteSource::fill_inflated() {
  if (inflater_.avail_in == 0) {
    const std::size_t count = read_raw(compressed_.data(), kChunk);
    compressed_read_ += count;
    inflater_.next_in = zlib_bytes(compressed_.data());
    inflater_.avail_in = static_cast<uInt>(count);
  }
  const std::string here = " at byte " + std::to_string(compressed_read_ - inflater_.avail_in) + " of the file";
  const bool no_input_left = inflater_.avail_in == 0;

  const std::size_t old_size = window_.size();
  window_.resize(old_size + kChunk);
  inflater_.next_out = zlib_bytes(window_.data() + old_size);
  inflater_.avail_out = static_cast<uInt>(kChunk);
  const int status = inflate(&inflater_, Z_NO_FLUSH);
  window_.resize(old_size + kChunk - inflater_.avail_out);

  if (status == Z_STREAM_END) {
    begin_next_member();
  } else if (status == Z_BUF_ERROR && no_input_left) {
    ended_ = true;
    cut_ = "the gzip data is cut off" + here;
  } else if (status != Z_OK && status != Z_BUF_ERROR) {
    ended_ = true;
    cut_ = "the gzip data is damaged" + here;
  }
}

/// Gzip files may be concatenated; anything else after the end of one is padding.
void ByteSource::begin_next_member() {
  std::size_t left = inflater_.avail_in;
  std::memmove(compressed_.data(), inflater_.next_in, left);
  const std::size_t count = read_raw(compressed_.data() + left, kChunk - left);
  compressed_read_ += count;
  left += count;
  inflater_.next_in = zlib_bytes(compressed_.data());
  inflater_.avail_in = static_cast<uInt>(left);
  ended_ = !starts_like_gzip(compressed_.data(), left) || inflateReset(&inflater_) != Z_OK;
}

}  // namespace shapemap
