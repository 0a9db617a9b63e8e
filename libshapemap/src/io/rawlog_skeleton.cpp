// SPDX-License-Identifier: GPL-3.0-or-later
#include "rawlog_skeleton.hpp"

#include <algorithm>
#include <cctype>
#include <cstring>

#include "log_formats.hpp"
#include "shapemap/scan/plausibility.hpp"

namespace shapemap {
namespace {

constexpr unsigned char kNameFlag = 0x80;  // set in the length of a class name
constexpr unsigned char kEndMark = 0x88;   // follows each object
constexpr std::size_t kLongestName = 120;
constexpr std::size_t kLongestHeader = kLongestName + 2;
constexpr auto kMostBeams = static_cast<std::uint32_t>(plausible::kMostBeams);
constexpr std::uint32_t kLargestMatrixSide = 16;
constexpr std::size_t kLongestLabel = 1U << 16U;

bool starts_with(std::string_view text, std::string_view start) { return text.substr(0, start.size()) == start; }

bool is_entry(std::string_view name) {
  return name == kFrameClass || name == "CActionCollection" || starts_with(name, "CObservation");
}

/// Walks along a serialised scan and fetches its bytes as far as they exist.
class Cursor {
 public:
  explicit Cursor(ByteSource& source) : source_(source) {}

  std::size_t offset() const { return offset_; }
  void advance(std::size_t count) {
    if (source_.ensure(offset_ + count) < offset_ + count) fail("the file ends inside of a scan");
    offset_ += count;
  }
  template <class Integer>
  Integer take() {
    advance(sizeof(Integer));
    Integer value{};
    std::memcpy(&value, source_.buffered().data() + offset_ - sizeof(Integer), sizeof(Integer));
    return value;
  }
  ObjectHeader header() {
    source_.ensure(offset_ + kLongestHeader);
    const std::optional<ObjectHeader> header = parse_object_header(source_.buffered().substr(offset_));
    if (!header) fail("no object where one should be");
    advance(header->length);
    return *header;
  }
  /// MRPT reads this byte straight into a bool, so that only 0 and 1 may stand there.
  bool take_bool() {
    const auto byte = take<std::uint8_t>();
    if (byte > 1) fail("a truth value of " + std::to_string(byte));
    return byte == 1;
  }
  void end_mark() {
    if (take<unsigned char>() != kEndMark) fail("an object does not end where it should");
  }
  [[noreturn]] void fail(const std::string& what) const { throw RawlogDamage{source_.offset() + offset_, what}; }

 private:
  ByteSource& source_;
  std::size_t offset_ = 0;
};

void pass_matrix(Cursor& cursor) {
  const ObjectHeader header = cursor.header();
  const std::size_t element = header.name == "CMatrixD" ? sizeof(double) : sizeof(float);
  const auto rows = cursor.take<std::uint32_t>();
  const auto columns = cursor.take<std::uint32_t>();
  if (rows > kLargestMatrixSide || columns > kLargestMatrixSide) cursor.fail("a matrix of impossible size");
  cursor.advance(rows * columns * element);
  cursor.end_mark();
}

void pass_pose(Cursor& cursor) {
  const ObjectHeader header = cursor.header();
  if (header.name != "CPose3D") cursor.fail("no sensor pose where one should be");
  switch (header.version) {
    case 0:
    case 1:
      pass_matrix(cursor);
      break;
    case 2:
      cursor.advance(7 * sizeof(double));
      break;  // position and quaternion
    case 3:
      cursor.advance(12 * sizeof(double));
      break;  // position and rotation matrix
    default:
      cursor.fail("a sensor pose of unknown version " + std::to_string(header.version));
  }
  cursor.end_mark();
}

/// Walks over one CObservation2DRangeScan, versions 0 to 7.
void pass_scan(Cursor& cursor) {
  const ObjectHeader header = cursor.header();
  const int version = header.version;
  if (header.name != kScanClass || version > 7) cursor.fail("a laser scan of unknown version");
  cursor.advance(sizeof(float));  // aperture
  cursor.take_bool();             // direction
  cursor.advance(sizeof(float));  // maximum range
  pass_pose(cursor);
  if (version < 6) pass_matrix(cursor);  // covariance of the sensor pose

  const auto num_beams = cursor.take<std::uint32_t>();
  if (num_beams > kMostBeams) cursor.fail("a laser scan of " + std::to_string(num_beams) + " beams");
  cursor.advance(num_beams * sizeof(float));
  if (version >= 1) cursor.advance(num_beams);              // valid flags
  if (version >= 2) cursor.advance(sizeof(float));          // standard deviation
  if (version >= 3) cursor.advance(sizeof(std::uint64_t));  // timestamp
  if (version >= 4) cursor.advance(sizeof(float));          // beam aperture
  if (version >= 5) {
    const auto length = cursor.take<std::uint32_t>();
    if (length > kLongestLabel) cursor.fail("a sensor label of " + std::to_string(length) + " bytes");
    cursor.advance(length + sizeof(double));  // label, pitch increment
  }
  if (version >= 7 && cursor.take_bool()) cursor.advance(num_beams * sizeof(std::int32_t));
  cursor.end_mark();
}

}  // namespace

std::optional<ObjectHeader> parse_object_header(std::string_view bytes) {
  if (bytes.empty() || (static_cast<unsigned char>(bytes[0]) & kNameFlag) == 0) return std::nullopt;
  const std::size_t length = static_cast<unsigned char>(bytes[0]) & 0x7FU;
  if (length < 2 || length > kLongestName || bytes.size() < length + 2) return std::nullopt;
  const std::string_view name = bytes.substr(1, length);
  const bool is_name = std::all_of(name.begin(), name.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == ':' || c == '<' || c == '>';
  });
  if (!is_name || std::isalpha(static_cast<unsigned char>(name.front())) == 0) return std::nullopt;
  const std::size_t colon = name.rfind(':');
  const std::string_view own_name = colon == std::string_view::npos ? name : name.substr(colon + 1);
  return ObjectHeader{own_name, static_cast<std::uint8_t>(bytes[1 + length]), length + 2};
}

bool looks_like_rawlog(std::string_view content) {
  const std::optional<ObjectHeader> header = parse_object_header(content);
  return header && is_entry(header->name);
}

ObjectHeader RawlogSkeleton::peek_header() {
  source_.ensure(kLongestHeader);
  const std::optional<ObjectHeader> header = parse_object_header(source_.buffered());
  if (!header && at_end()) throw RawlogDamage{offset(), "the file ends inside of a frame"};
  if (!header) throw RawlogDamage{offset(), "no object where one should be"};
  return *header;
}

std::uint32_t RawlogSkeleton::enter_frame() {
  Cursor cursor(source_);
  const ObjectHeader header = cursor.header();
  if (header.version > 2) cursor.fail("a frame of unknown version");
  if (header.version < 2) cursor.advance(sizeof(std::uint32_t));   // identifier
  if (header.version == 0) cursor.advance(sizeof(std::uint64_t));  // timestamp
  const auto num_observations = cursor.take<std::uint32_t>();
  skip(cursor.offset());
  return num_observations;
}

void RawlogSkeleton::leave_frame() {
  Cursor cursor(source_);
  cursor.end_mark();
  skip(cursor.offset());
}

std::string_view RawlogSkeleton::peek_scan() {
  Cursor cursor(source_);
  pass_scan(cursor);
  return source_.buffered().substr(0, cursor.offset());
}

/// Objects do not state their length. The end is an end mark in front of the name of the next entry, which does not
/// occur inside of other objects.
void RawlogSkeleton::skip_object() {
  skip(peek_header().length);
  unsigned char last = 0;
  while (source_.ensure(1 + kLongestHeader) > 0) {
    const std::string_view bytes = source_.buffered();
    const std::size_t mark = std::min(bytes.find(static_cast<char>(kEndMark)), bytes.size());
    if (mark > 0) {
      last = static_cast<unsigned char>(bytes[mark - 1]);
      skip(mark);
      continue;
    }
    const std::optional<ObjectHeader> next = parse_object_header(bytes.substr(1));
    const bool at_next_entry = next && is_entry(next->name);
    skip(1);
    if (at_next_entry) return;
    last = kEndMark;
  }
  if (last != kEndMark) throw RawlogDamage{offset(), "the file ends inside of an object"};
}

}  // namespace shapemap
