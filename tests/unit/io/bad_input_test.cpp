// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "support/logs.hpp"
#include "support/temp_folder.hpp"

namespace shapemap {
namespace {

using test::input_error;
using test::TempFolder;
using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::string carmen_lines(int count) {
  std::mt19937 rng(7);
  std::uniform_int_distribution<int> centimetres(50, 500);
  std::string content;
  for (int i = 0; i < count; ++i) {
    content += "FLASER 181";
    for (int beam = 0; beam < 181; ++beam) content += " " + std::to_string(centimetres(rng) / 100.0);
    content += " 0 0 0 0 0 0 " + std::to_string(i) + " host 0\n";
  }
  return content;
}

TEST(BadInput, WhatIsNoFileOrEmpty) {
  const TempFolder folder;
  EXPECT_THAT(input_error(folder.path("none")), EndsWith("/none: cannot be read: No such file or directory"));
  EXPECT_THAT(input_error(folder.path("")), HasSubstr("is a directory, expected a laser log"));
  EXPECT_THAT(input_error(folder.write("empty", "")), HasSubstr("is empty"));
  EXPECT_THAT(input_error(folder.write_gz("empty.gz", "")), HasSubstr("empty.gz"));
}

TEST(BadInput, WhatIsNoLog) {
  const TempFolder folder;
  std::mt19937 rng(1);
  std::string junk;
  for (int i = 0; i < 5000; ++i) junk += static_cast<char>(rng() & 0xFFU);
  EXPECT_THAT(input_error(folder.write("junk", junk)), HasSubstr("expected an MRPT rawlog"));
  EXPECT_THAT(input_error(folder.write_gz("junk.gz", junk)), HasSubstr("expected an MRPT rawlog"));
  EXPECT_THAT(input_error(folder.write("prose", "\nlorem ipsum\ndolor\n")),
              AllOf(HasSubstr("prose:2: unknown log format"), HasSubstr("shapemap-scans 1"), Not(HasSubstr("\n"))));
  EXPECT_THAT(input_error(folder.write("letter", "Dear reader,\n12 monkeys\n1 2 3\n")),
              HasSubstr("letter:1: unknown log format; expected an MRPT rawlog"));
  EXPECT_THAT(input_error(folder.write("odom", "ODOM 1 2 3\n")), HasSubstr("no 2D laser scans"));
}

TEST(BadInput, AForcedFormatThatDoesNotFit) {
  const TempFolder folder;
  const std::string carmen = folder.write("a.log", carmen_lines(2));
  EXPECT_THAT(input_error(carmen, LogFormat::kRawlog), HasSubstr("no MRPT rawlog"));
  EXPECT_THAT(input_error(carmen, LogFormat::kNist), HasSubstr("a.log:1: 'FLASER' where 'shapemap-scans 1'"));
  const std::string zero = folder.write("zero", std::string("a\0b\x7F 1", 6) + "\n");
  EXPECT_THAT(input_error(zero, LogFormat::kNist), HasSubstr("zero:1: 'a\\x00b\\x7f' where"));
  EXPECT_THAT(input_error(folder.write("b.nist", "shapemap-scans 1\n"), LogFormat::kCarmen),
              HasSubstr("no 2D laser scans"));
}

TEST(BadInput, FormatsAreRecognisedByContentAlone) {
  const TempFolder folder;
  EXPECT_EQ(recognise_log_format(folder.write("a.rawlog", carmen_lines(1))), LogFormat::kCarmen);
  EXPECT_EQ(recognise_log_format(folder.write_gz("b.nist", carmen_lines(1))), LogFormat::kCarmen);
  EXPECT_EQ(recognise_log_format(folder.write("c.log", "\xEF\xBB\xBFshapemap-scans 1\n")), LogFormat::kNist);
  EXPECT_EQ(recognise_log_format(folder.write_gz("d.gz", "# remark\n\n1.5 2 3\n")), LogFormat::kNist);
}

TEST(BadInput, CutGzipGivesWhatIsWholeAndAWarning) {
  const TempFolder folder;
  const std::string whole = test::read_file(folder.write_gz("whole.gz", carmen_lines(60)));
  const Log all = read_log(folder.path("whole.gz"));
  ASSERT_EQ(all.scans.size(), 60U);
  EXPECT_TRUE(all.warnings.empty());

  const Log cut = read_log(folder.write("cut.gz", whole.substr(0, whole.size() / 2)));
  EXPECT_GT(cut.scans.size(), 10U);
  EXPECT_LT(cut.scans.size(), 50U);
  EXPECT_THAT(
      cut.warnings,
      ElementsAre(AllOf(HasSubstr("cut.gz: the gzip data is cut off at byte " + std::to_string(whole.size() / 2)),
                        HasSubstr("the " + std::to_string(cut.scans.size()) + " positions"))));
  for (std::size_t i = 0; i < cut.scans.size(); ++i) {
    EXPECT_EQ(cut.scans[i].sweeps[0].ranges_m, all.scans[i].sweeps[0].ranges_m);
  }
}

TEST(BadInput, GzipCutAnywhereNeverFailsOtherwise) {
  const TempFolder folder;
  const std::string whole = test::read_file(folder.write_gz("whole.gz", carmen_lines(3)));
  for (std::size_t length = 1; length < whole.size(); ++length) {
    const std::string path = folder.write("cut.gz", whole.substr(0, length));
    try {
      const Log log = read_log(path);
      EXPECT_FALSE(log.scans.empty());
      EXPECT_EQ(log.warnings.size(), 1U) << length;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("cut.gz"));
    }
  }
}

TEST(BadInput, AWrongChecksumIsReported) {
  const TempFolder folder;
  std::string content = test::read_file(folder.write_gz("a.gz", carmen_lines(60)));
  content[content.size() - 6] ^= 1;
  const Log log = read_log(folder.write("a.gz", content));
  EXPECT_EQ(log.scans.size(), 60U);
  EXPECT_THAT(log.warnings, ElementsAre(HasSubstr("a.gz: the gzip data is damaged at byte")));
}

TEST(BadInput, DamagedGzipIsNeverTakenForWhole) {
  const TempFolder folder;
  const std::string whole = test::read_file(folder.write_gz("a.gz", carmen_lines(60)));
  for (std::size_t begin = 20; begin + 40 < whole.size(); begin += 499) {
    std::string content = whole;
    for (std::size_t i = begin; i < begin + 40; ++i) content[i] ^= '\x55';
    const std::string path = folder.write("b.gz", content);
    try {
      EXPECT_FALSE(read_log(path).warnings.empty()) << begin;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("b.gz"));
    }
  }
}

TEST(BadInput, RandomEditsOfTextLogsNeverDoMoreThanAnInputError) {
  const TempFolder folder;
  const std::string nist =
      "shapemap-scans 1\nunits cm deg\nsensor l beams 3 first_angle -50 "
      "angle_step 25 max_range 2000 mount 1 2 3 4 5 6\n"
      "position 1 reference 1 2 3\nscan l heading 0 ranges 1 2 -\n";
  const std::string robot_laser =
      "# shapemap mount 1 2 3 4 5 6\nROBOTLASER1 0 -1 2 1 8 0 0 3 1 2 3 1 5 "
      "0 0 0 0 0 0 0 0 0 0 0 5 h 1\n# shapemap same-position\n"
      "FLASER 3 1 2 3 0 0 0 0 0 0 1 h 1\n";
  const std::string alphabet = "0123456789-+.e# \n\tnaif\r";
  std::mt19937 rng(5);
  LogReadOptions options;
  options.fov_rad = 1.0;
  for (int run = 0; run < 2000; ++run) {
    std::string content = run % 2 == 0 ? nist : robot_laser;
    for (int edits = 1 + static_cast<int>(rng() % 3U); edits > 0; --edits) {
      content[rng() % content.size()] = alphabet[rng() % alphabet.size()];
    }
    const std::string path = folder.write("a.log", content);
    for (const LogFormat format : {LogFormat::kAuto, LogFormat::kCarmen, LogFormat::kNist}) {
      try {
        EXPECT_LE(read_log(path, format, options).scans.size(), 8U);
      } catch (const InputError& error) {
        EXPECT_THAT(error.what(), AllOf(HasSubstr("a.log"), Not(HasSubstr("\n"))));
      }
    }
  }
}

TEST(BadInput, JoinedGzipFilesAreOneLog) {
  const TempFolder folder;
  const std::string one = test::read_file(folder.write_gz("one.gz", carmen_lines(20)));
  const Log log = read_log(folder.write("two.gz", one + one));
  EXPECT_EQ(log.scans.size(), 40U);
  EXPECT_THAT(log.warnings, testing::ElementsAre(HasSubstr("1 times the clock goes back")));
}

}  // namespace
}  // namespace shapemap
