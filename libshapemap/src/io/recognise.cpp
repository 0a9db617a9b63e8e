// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <string>
#include <string_view>

#include "log_formats.hpp"
#include "shapemap/core/errors.hpp"
#include "text.hpp"

namespace shapemap {
namespace {

constexpr std::size_t kPeekedBytes = 1U << 20U;
constexpr std::array<std::string_view, 11> kCarmenWords{"FLASER",    "RLASER",  "ROBOTLASER1", "ROBOTLASER2",
                                                        "PARAM",     "SYNC",    "ODOM",        "TRUEPOS",
                                                        "RAWLASER1", "NMEAGGA", "MARKER"};
constexpr const char* kExpected =
    "expected an MRPT rawlog, a CARMEN log (FLASER or ROBOTLASER1 lines), a text log that begins with "
    "'shapemap-scans 1', or lines of numbers";

bool is_carmen_word(std::string_view word) {
  for (const std::string_view known : kCarmenWords) {
    if (word == known) return true;
  }
  return false;
}

/// Returns what a text line tells about the format of its file; kAuto is nothing.
LogFormat format_of_line(std::string_view line) {
  Words words(line, ',');
  const std::string_view first = words.next();
  if (first.empty() || first.front() == '#') return LogFormat::kAuto;
  if (first == "shapemap-scans") return LogFormat::kNist;
  if (is_carmen_word(first)) return LogFormat::kCarmen;
  if (parse_range(first, 1.0)) return LogFormat::kNist;
  return LogFormat::kAuto;
}

bool is_binary(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte < 0x20 && c != '\n' && c != '\r' && c != '\t' && c != '\v' && c != '\f';
}

}  // namespace

LogFormat recognise_log_format(ByteSource& source) {
  source.ensure(kPeekedBytes);
  std::string_view content = source.buffered().substr(0, kPeekedBytes);
  if (looks_like_rawlog(content)) return LogFormat::kRawlog;
  if (content.empty()) throw InputError(source.path() + ": " + source.cut() + ", nothing can be read before that");
  if (content.substr(0, 3) == "\xEF\xBB\xBF") content.remove_prefix(3);

  std::size_t line_number = 0;
  std::size_t first_statement = 0;
  for (std::size_t begin = 0; begin < content.size();) {
    ++line_number;
    const std::size_t end = std::min(content.find('\n', begin), content.size());
    const std::string_view line = content.substr(begin, end - begin);
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (!is_binary(line[i])) continue;
      throw InputError(source.path() + ": unknown binary format (byte " + std::to_string(begin + i) + " is no text); " +
                       kExpected);
    }
    // A NIST log names its format in its first statement; CARMEN logs may begin with anything.
    const LogFormat format = format_of_line(line);
    const bool counts = format == LogFormat::kNist ? first_statement == 0 : format != LogFormat::kAuto;
    if (counts) return format;
    Words words(line);
    const std::string_view first = words.next();
    if (first_statement == 0 && !first.empty() && first.front() != '#') first_statement = line_number;
    begin = end + 1;
  }
  const std::string where = first_statement > 0 ? ":" + std::to_string(first_statement) : "";
  throw InputError(source.path() + where + ": unknown log format; " + kExpected);
}

LogFormat recognise_log_format(const std::string& path) {
  ByteSource source(path);
  return recognise_log_format(source);
}

}  // namespace shapemap
