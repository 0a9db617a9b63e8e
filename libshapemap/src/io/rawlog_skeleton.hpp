// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "byte_source.hpp"

/// The skeleton of a rawlog tells where its entries, frames and laser scans begin and end.
///
/// MRPT's deserialisers allocate whatever a count in the file says before they check whether the file has that much, so
/// that one wrong bit can ask for gigabytes. They also must read odometry and images to get past them. Therefore the
/// skeleton is followed without MRPT: laser scans are measured against the bytes that exist, and only such a checked
/// slice is given to MRPT; everything else is skipped unread, by searching for the next entry's name.
namespace shapemap {

/// The rawlog ends too early or holds something impossible.
struct RawlogDamage {
  std::uint64_t offset = 0;
  std::string what;
};

/// Every object begins with its class name and version.
struct ObjectHeader {
  std::string_view name;  ///< without namespaces, which MRPT 2 writes and MRPT 1 did not; valid until more is read
  std::uint8_t version = 0;
  std::size_t length = 0;  ///< length of the header itself
};

inline constexpr std::string_view kScanClass = "CObservation2DRangeScan";
inline constexpr std::string_view kFrameClass = "CSensoryFrame";

class RawlogSkeleton {
 public:
  explicit RawlogSkeleton(ByteSource& source) : source_(source) {}

  bool at_end() { return source_.ensure(1) == 0; }
  std::uint64_t offset() const { return source_.offset(); }
  /// Returns the header at the current offset. Throws RawlogDamage when there is none.
  ObjectHeader peek_header();
  /// Steps into the frame at the current offset and returns how many observations follow.
  std::uint32_t enter_frame();
  /// Steps over the end mark of a frame.
  void leave_frame();
  /// Returns the whole serialised scan at the current offset, whose counts have been checked; call skip() afterwards.
  std::string_view peek_scan();
  void skip(std::size_t count) { source_.consume(count); }
  /// Steps over an object of any class to the next entry or observation, or to the end. The end mark of a frame, if the
  /// object is the last one in it, is stepped over as well.
  void skip_object();

 private:
  ByteSource& source_;
};

/// Parses the header at the front of `bytes`; returns nothing when there is none, or when it is not whole.
std::optional<ObjectHeader> parse_object_header(std::string_view bytes);

}  // namespace shapemap
