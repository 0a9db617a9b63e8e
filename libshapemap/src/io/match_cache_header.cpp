// SPDX-License-Identifier: GPL-3.0-or-later
#include "match_cache_header.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <type_traits>

#include "match_cache_record.hpp"
#include "shapemap/core/version.hpp"
#include "text.hpp"

namespace shapemap {
namespace {

// as in PNG, this ends programs that print the file, and reveals changed line ends
constexpr std::string_view kMagic = "shm-state\n\x1a\n";
constexpr std::uint32_t kFormat = 1;
constexpr std::size_t kTextAt = kMagic.size() + 8;
constexpr std::size_t kMostNamed = 4;

/// The fingerprint is FNV-1a with 64 bits (Fowler, Noll, Vo) over numbers to the last bit.
class Fingerprint {
 public:
  template <class Number>
  void add(Number number) {
    static_assert(std::is_arithmetic_v<Number>);
    unsigned char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    for (const unsigned char byte : bytes) value_ = (value_ ^ byte) * 0x100000001B3U;
  }
  std::string text() const {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value_));
    return text;
  }

 private:
  std::uint64_t value_ = 0xCBF29CE484222325U;
};

/// Covers all of a log that matches depend on.
std::string fingerprint(const Log& log) {
  Fingerprint print;
  for (const Scan& scan : log.scans) {
    print.add(static_cast<std::uint64_t>(scan.sweeps.size()));
    for (const Sweep& sweep : scan.sweeps) {
      print.add(static_cast<std::uint64_t>(sweep.ranges_m.size()));
      for (const float range_m : sweep.ranges_m) print.add(range_m);
      for (const double angle_rad : sweep.beam_angles_rad) print.add(angle_rad);
      const MountPose& mount = sweep.robot_from_sensor;
      for (const double number :
           {sweep.first_angle_rad, sweep.angle_step_rad, sweep.min_range_m, sweep.max_range_m, mount.x_m, mount.y_m,
            mount.z_m, mount.yaw_rad, mount.pitch_rad, mount.roll_rad, sweep.nominal_heading_rad}) {
        print.add(number);
      }
    }
  }
  return print.text();
}

/// Writes a value in the unit of the option's name, and such that different values have different texts.
std::string option_text(const Field& field, double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.14g", value / field.unit);
  if (std::strtod(text, nullptr) * field.unit == value) return text;
  std::string exact;
  append_number(exact, value / field.unit);
  return exact;
}

template <class Group>
void append_options(std::string& text, const Group& group) {
  Group::fields(group, [&](const Field& field, const auto& value) {
    using Value = std::decay_t<decltype(value)>;
    const std::string_view old_name = field.old_name;  // files of before stay what they are
    text += std::string(old_name.empty() ? field.name : old_name) + " = ";
    if constexpr (std::is_enum_v<Value>) {
      text += enum_name(value);
    } else {
      text += option_text(field, static_cast<double>(value));
    }
    text += "\n";
  });
}

using Lines = std::map<std::string, std::string>;

Lines lines_of(std::string_view text) {
  Lines lines;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    const std::size_t sign = line.find(" = ");
    if (sign != std::string_view::npos) lines[std::string(line.substr(0, sign))] = line.substr(sign + 3);
    text.remove_prefix(std::min(text.size(), line.size() + 1));
  }
  return lines;
}

std::string text_difference(Lines found, Lines expected) {
  if (found["shapemap"] != expected["shapemap"]) {
    return "was made by shapemap " + found["shapemap"] + ", this is " + expected["shapemap"];
  }
  if (found["positions"] != expected["positions"]) {
    return "is of another log, or of other positions of it: of " + found["positions"] + ", not " +
           expected["positions"];
  }
  std::string named;
  std::size_t count = 0;
  for (const auto& [name, value] : expected) {
    if (name == "readings" || found[name] == value) continue;
    if (++count <= kMostNamed) named += (count > 1 ? ", --" : "--") + name + " " + found[name] + " instead of " + value;
  }
  // Options may change what is read, so that they are named first.
  const bool same_readings = found["readings"] == expected["readings"];
  if (count == 0) return same_readings ? "" : "is of another log, or of other positions of it, just as many";
  return "was made with " + named + (count > kMostNamed ? " and more" : "");
}

}  // namespace

std::string state_header(const Log& log, const MappingOptions& options) {
  std::string text = "shapemap = " + std::string(kVersion) + "\npositions = " + std::to_string(log.scans.size()) +
                     "\nreadings = " + fingerprint(log) + "\n";
  const MatchSearchOptions& search = options.robust.matcher.search;
  append_options(text, options.deskew);
  append_options(text, options.returns);
  append_options(text, options.polylines);
  append_options(text, options.shape);
  append_options(text, options.robust.matcher.view);
  append_options(text, search.voting);
  append_options(text, search.candidates);
  append_options(text, search.visibility);
  append_options(text, search.line);
  std::string header(kMagic);
  append_u32(header, kFormat);
  append_u32(header, static_cast<std::uint32_t>(text.size()));
  header += text;
  append_u32(header, checksum_of(header));
  return header;
}

std::string header_difference(std::string_view found, std::string_view expected) {
  if (found.substr(0, expected.size()) == expected) return "";
  if (found.size() < kTextAt || found.substr(0, kMagic.size()) != kMagic) return "is not a state of shapemap";
  if (const std::uint32_t format = u32_at(found, kMagic.size()); format != kFormat) {
    return "has format " + std::to_string(format) + ", this shapemap reads " + std::to_string(kFormat);
  }
  const std::size_t text_size = u32_at(found, kMagic.size() + 4);
  if (text_size + 4 > found.size() - kTextAt ||
      checksum_of(found.substr(0, kTextAt + text_size)) != u32_at(found, kTextAt + text_size)) {
    return "is damaged: its beginning does not have its checksum";
  }
  const auto text_of = [](std::string_view header, std::size_t size) { return header.substr(kTextAt, size); };
  const std::string why = text_difference(lines_of(text_of(found, text_size)),
                                          lines_of(text_of(expected, u32_at(expected, kMagic.size() + 4))));
  return why.empty() ? "lists other options than this shapemap has" : why;
}

}  // namespace shapemap
