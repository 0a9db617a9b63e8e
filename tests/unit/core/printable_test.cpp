// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/core/printable.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace shapemap {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

TEST(Printable, LeavesTextOfAnyLanguageAsItIs) {
  for (const char* text :
       {"", "laser 1: 3 > 2", "caf\xC3\xA9", "\xE6\xBF\x80\xE5\x85\x89", "\xF0\x9F\x97\xBA\xEF\xB8\x8F", "a\\b"}) {
    EXPECT_EQ(printable(text), text);
  }
}

TEST(Printable, EscapesWhatATerminalObeys) {
  EXPECT_EQ(printable("\x1B[31mred\x1B[0m\a"), "\\x1b[31mred\\x1b[0m\\x07");
  EXPECT_EQ(printable("a\r\nb\tc\x7F"), "a\\x0d\\x0ab\\x09c\\x7f");
  EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("\xC2\x9B"
                      "31m"),
            "\\xc2\\x9b31m");                               // C1 begins an escape sequence
  EXPECT_EQ(printable("\xE2\x80\xAE"), "\\xe2\\x80\\xae");  // writes from right to left
  EXPECT_EQ(printable("\xE2\x80\xA8"), "\\xe2\\x80\\xa8");  // separates lines
  EXPECT_EQ(printable("\xEF\xBB\xBF"), "\\xef\\xbb\\xbf");
}

TEST(Printable, EscapesBytesThatAreNoUtf8) {
  EXPECT_EQ(printable("a\x9Bz"), "a\\x9bz");
  EXPECT_EQ(printable("\xC0\x9B"), "\\xc0\\x9b");                    // longer than needed
  EXPECT_EQ(printable("\xE0\x80\x9B"), "\\xe0\\x80\\x9b");           // longer than needed, too
  EXPECT_EQ(printable("\xED\xA0\x80"), "\\xed\\xa0\\x80");           // half of a UTF-16 character
  EXPECT_EQ(printable("\xF4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // beyond the last character
  EXPECT_EQ(printable("\xE6\xBF"), "\\xe6\\xbf");                    // cut off
  EXPECT_EQ(printable("\xE6(\x80"), "\\xe6(\\x80");
}

TEST(Printable, CutsTheMiddleOfWhatIsLong) {
  const std::string text = "first" + std::string(100'000, '-') + "last";
  const std::string shown = printable(text, 100);
  EXPECT_THAT(shown, StartsWith("first"));
  EXPECT_THAT(shown, EndsWith("last"));
  EXPECT_THAT(shown, HasSubstr("- ... -"));
  EXPECT_LE(shown.size(), 105U);
  EXPECT_EQ(printable(std::string(100, 'x'), 100), std::string(100, 'x'));
  // The cut never falls within a character.
  for (std::size_t most = 3; most < 40; ++most) {
    std::string accents;
    for (int i = 0; i < 200; ++i) accents += "\xC3\xA9";
    EXPECT_EQ(printable(accents, most).find('\\'), std::string::npos) << most;
    EXPECT_EQ(printable(printable(accents, most)), printable(accents, most)) << most;
  }
}

TEST(Printable, OfRandomBytesIsOneLineOfHarmlessText) {
  std::mt19937 rng(5);
  for (int run = 0; run < 2000; ++run) {
    std::string text;
    for (std::size_t i = rng() % 60; i > 0; --i) text += static_cast<char>(rng() % 256);
    const std::string shown = printable(text);
    for (const char c : shown) {
      ASSERT_GE(static_cast<unsigned char>(c), 0x20);
      ASSERT_NE(c, '\x7F');
    }
    ASSERT_EQ(printable(shown, 10'000), shown) << "all of it is harmless, and is left as it is";
  }
}

}  // namespace
}  // namespace shapemap
