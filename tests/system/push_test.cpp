// SPDX-License-Identifier: GPL-3.0-or-later
// A real log that is pushed into a mapper: the folder named by SHAPEMAP_DATASETS.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "shapemap/io/log_file.hpp"
#include "shapemap/mapper/map_log.hpp"
#include "shapemap/mapper/mapper.hpp"
#include "support/map_results.hpp"

namespace shapemap {
namespace {

Log begin_of_orebro(std::size_t count) {
  const char* folder = std::getenv("SHAPEMAP_DATASETS");
  const std::filesystem::path path = std::filesystem::path(folder ? folder : "") / "carmen" / "orebro-corrected.log.gz";
  if (!folder || !std::filesystem::exists(path)) return {};
  Log log = read_log(path.string());
  log.scans.resize(std::min(count, log.scans.size()));
  return log;
}

TEST(PushedRealLog, GivesTheMapOfTheLogHoweverScansAreGrouped) {
  const Log log = begin_of_orebro(60);
  if (log.scans.empty()) GTEST_SKIP() << "needs carmen/orebro-corrected.log.gz in SHAPEMAP_DATASETS";
  MappingEvents nobody;
  MappingOptions options;
  options.run.threads = 1;
  const MapResult expected = map_log(log, options, nobody);
  ASSERT_GT(expected.placed().size(), 40U);
  for (const std::size_t group : {std::size_t{1}, std::size_t{7}, log.scans.size()}) {
    for (const int threads : {1, 2}) {
      SCOPED_TRACE(testing::Message() << group << " at a time, " << threads << " threads");
      options.run.threads = threads;
      LiveOptions live;
      live.in_background = threads == 2;
      Mapper mapper(options, live);
      for (std::size_t first = 0; first < log.scans.size(); first += group) {
        mapper.add_scans(&log.scans[first], std::min(group, log.scans.size() - first));
      }
      MapResult result = mapper.finish();
      test::expect_same_bits(result, expected);
    }
  }
}

}  // namespace
}  // namespace shapemap
