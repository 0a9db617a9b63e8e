// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/core/printable.hpp"

#include <algorithm>
#include <cstdint>

namespace shapemap {
namespace {

constexpr std::string_view kCut = " ... ";

struct Character {
  std::size_t length = 1;  ///< number of bytes
  bool is_shown = false;
};

bool is_harmless(std::uint32_t code) {
  if (code < 0x20 || (code >= 0x7F && code < 0xA0)) return false;
  if (code >= 0xD800 && code < 0xE000) return false;   // these are halves of UTF-16 characters
  if (code >= 0x200B && code <= 0x200F) return false;  // these have no width, or mark the direction of writing
  if (code >= 0x2028 && code <= 0x202E) return false;  // these separate lines, or override the direction of writing
  if (code >= 0x2060 && code <= 0x206F) return false;
  return code != 0x61C && code != 0xFEFF && code <= 0x10FFFF;
}

/// Returns the character that begins at text[at], or that single byte when no character begins there.
Character character_at(std::string_view text, std::size_t at) {
  const auto first = static_cast<unsigned char>(text[at]);
  if (first < 0x80) return {1, is_harmless(first)};
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || length > text.size() - at) return {};
  std::uint32_t code = first & (0x7FU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    const auto byte = static_cast<unsigned char>(text[at + i]);
    if ((byte & 0xC0U) != 0x80U) return {};
    code = code << 6U | (byte & 0x3FU);
  }
  constexpr std::uint32_t kLeastOf3 = 0x800;
  constexpr std::uint32_t kLeastOf4 = 0x10000;
  if (code < (length == 4 ? kLeastOf4 : length == 3 ? kLeastOf3 : 0U)) return {};  // the encoding is longer than needed
  return {length, is_harmless(code)};
}

void append_escaped(std::string& shown, char c) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  const auto byte = static_cast<unsigned char>(c);
  shown += {'\\', 'x', kDigits[byte >> 4U], kDigits[byte & 0xFU]};
}

std::string escaped(std::string_view text) {
  std::string shown;
  for (std::size_t at = 0; at < text.size();) {
    const Character character = character_at(text, at);
    for (std::size_t i = at; i < at + character.length; ++i) {
      if (character.is_shown) {
        shown += text[i];
      } else {
        append_escaped(shown, text[i]);
      }
    }
    at += character.length;
  }
  return shown;
}

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

}  // namespace

std::string printable(std::string_view text, std::size_t most) {
  // No character becomes shorter when it is escaped, so the part that is cut away need not be escaped.
  if (text.size() / 2 > most) {
    return printable(std::string(text.substr(0, most)) + std::string(text.substr(text.size() - most)), most);
  }
  std::string shown = escaped(text);
  if (shown.size() <= most) return shown;
  // The cut never falls within a character.
  std::size_t head = most / 2;
  std::size_t tail = shown.size() - std::min(most - head, shown.size());
  while (head > 0 && continues(shown[head])) --head;
  while (tail < shown.size() && continues(shown[tail])) ++tail;
  return shown.substr(0, head) + std::string(kCut) + shown.substr(tail);
}

}  // namespace shapemap
