// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace shapemap {

/// Reads the content of a file from front to back through a window that grows only with bytes that really exist. Gzip
/// is recognised from the first bytes, never from the name: MRPT's tools write gzip into plain `.rawlog` files.
class ByteSource {
 public:
  /// Throws InputError when the file is missing, a directory, unreadable or empty.
  explicit ByteSource(std::string path);
  ~ByteSource();
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  /// Buffers at least `count` bytes, unless the content ends before, and returns how many are buffered.
  std::size_t ensure(std::size_t count);
  /// The view is valid until the next call that is not const.
  std::string_view buffered() const { return {window_.data() + begin_, window_.size() - begin_}; }
  void consume(std::size_t count) { begin_ += count; }

  /// Returns the offset of the first buffered byte in the (decompressed) content.
  std::uint64_t offset() const { return consumed_before_window_ + begin_; }
  const std::string& path() const { return path_; }
  /// Tells why a gzip stream ended early, and where; empty when it did not, or when that is not known yet.
  const std::string& cut() const { return cut_; }

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::size_t read_raw(char* to, std::size_t count);
  void drop_consumed();
  void fill();
  void fill_inflated();
  void begin_next_member();

  std::string path_;
  std::unique_ptr<std::FILE, CloseFile> file_;
  std::vector<char> window_;
  std::size_t begin_ = 0;
  std::uint64_t consumed_before_window_ = 0;
  bool ended_ = false;

  bool is_gzip_ = false;
  z_stream inflater_{};
  std::vector<char> compressed_;
  std::uint64_t compressed_read_ = 0;
  std::string cut_;
};

}  // namespace shapemap
