// SPDX-License-Identifier: GPL-3.0-or-later
// Logs of each format get damaged headers, and are read and mapped. SHAPEMAP_MUTATIONS says how many; a run of 3000
// with sanitizers takes about a quarter of an hour.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <random>

#include "io/match_cache_record.hpp"
#include "shapemap/io/match_cache_file.hpp"
#include "shapemap/scan/beam_angles.hpp"
#include "support/hostile_log.hpp"
#include "support/synthetic_world.hpp"
#include "support/temp_folder.hpp"

namespace shapemap {
namespace {

using test::Outcome;
using test::TempFolder;

constexpr int kFewMutations = 120;
constexpr unsigned kLongest_s = 60;  // of one log; with sanitizers on a busy machine an unharmed log takes one
constexpr long kMostGrowth_KiB = 2 * 1024 * 1024;

int num_mutations() {
  const char* wanted = std::getenv("SHAPEMAP_MUTATIONS");
  return wanted != nullptr ? std::atoi(wanted) : kFewMutations;
}

/// Walks through a room with few beams.
Log walk(int num_scans = 3, double step_m = 0.2) {
  Log log;
  test::Scanner scanner;
  scanner.num_beams = 60;
  scanner.view_rad = kPi;
  for (int i = 0; i < num_scans; ++i) {
    log.scans.push_back(test::scan_of(test::uneven_room(), {step_m * i, 0.05 * i, 0.05 * i}, scanner));
    log.scans.back().timestamp_s = 100.0 + i;
    Sweep& sweep = log.scans.back().sweeps.front();
    sweep.sensor_label = "laser";
    sweep.robot_from_sensor = {0.1, -0.1, 0.3, 0.02, 0.01, -0.01};
  }
  return log;
}

std::string readings(const Sweep& sweep) {
  std::string text;
  for (const float range_m : sweep.ranges_m) text += " " + std::to_string(range_m);
  return text;
}

/// Writes the same walk by the convention of 180 readings.
std::string flaser_lines() {
  Log log = walk();
  std::string text = "PARAM robot_front_laser_max 20.0 host 0\n";
  for (Scan& scan : log.scans) {
    Sweep sweep = scan.sweeps.front();
    std::vector<float> ranges_m;
    for (const float range_m : sweep.ranges_m) ranges_m.insert(ranges_m.end(), 3, range_m);
    sweep.ranges_m = ranges_m;
    text += "FLASER 180" + readings(sweep) + " 0 0 0 0 0 0 " + std::to_string(scan.timestamp_s) + " host 0\n";
  }
  return text;
}

/// Only the second version of the text format can hold this log: ten sweeps a second, whose beams have times; one of
/// them has angles and intensities of its own.
Log rolling_walk() {
  constexpr double kPeriod_s = 0.1;
  Log log = walk(5, 0.05);
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    log.scans[i].timestamp_s = 100.0 + kPeriod_s * static_cast<double>(i);
    Sweep& sweep = log.scans[i].sweeps.front();
    sweep.beam_time_step_s = kPeriod_s / 120;
    sweep.start_s = 0.01;
    if (i != 2) continue;
    std::vector<double> angles_rad;
    for (std::size_t k = 0; k < sweep.ranges_m.size(); ++k) angles_rad.push_back(sweep.beam_angle_rad(k));
    set_beam_angles(sweep, angles_rad);
    sweep.intensities.assign(sweep.ranges_m.size(), 7.0F);
  }
  return log;
}

struct Sample {
  std::string name;
  std::string content;
  bool is_text = true;
};

std::vector<Sample> samples(const TempFolder& folder) {
  const Log log = walk();
  std::vector<Sample> all{{"flaser", flaser_lines()}, {"bare", ""}};
  for (const Scan& scan : log.scans) all.back().content += readings(scan.sweeps.front()) + "\n";
  for (const auto& [name, format] :
       {std::pair{"nist", LogFormat::kNist}, std::pair{"robotlaser", LogFormat::kCarmen}}) {
    write_log(log, folder.path(name), format);
    all.push_back({name, test::read_file(folder.path(name))});
  }
  write_log(rolling_walk(), folder.path("rolling"), LogFormat::kNist);
  all.push_back({"rolling", test::read_file(folder.path("rolling"))});
  write_log(log, folder.path("rawlog"), LogFormat::kRawlog);
  all.push_back({"rawlog", test::read_gz(folder.path("rawlog")), false});
  return all;
}

/// Headers are to be mutated, so that only the first few words of a long row of numbers count.
std::vector<std::pair<std::size_t, std::size_t>> header_words(const std::string& text) {
  constexpr std::size_t kFirstReadings = 14;
  constexpr std::size_t kLastWords = 14;
  std::vector<std::pair<std::size_t, std::size_t>> found;
  std::vector<std::pair<std::size_t, std::size_t>> line;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find_first_of(" \n", at), text.size());
    if (end > at) line.emplace_back(at, end - at);
    if (end == text.size() || text[end] == '\n') {
      for (std::size_t i = 0; i < line.size(); ++i) {
        if (i < kFirstReadings || i + kLastWords >= line.size()) found.push_back(line[i]);
      }
      line.clear();
    }
    at = end + 1;
  }
  return found;
}

class Mutator {
 public:
  explicit Mutator(unsigned seed) : rng_(seed) {}

  std::string mutated(const Sample& sample) {
    std::string content = sample.content;
    for (std::size_t count = 1 + below(3); count > 0; --count) {
      if (below(8) == 0) {
        cut_or_double(content);
      } else if (sample.is_text && below(3) != 0) {
        change_word(content);
      } else {
        change_bytes(content, sample.is_text);
      }
    }
    return content;
  }

  double odd_number() {
    constexpr double kInf = std::numeric_limits<double>::infinity();
    const std::vector<double> odd{0.0,    -0.0, 1.0,   -1.0,  1e6,  -1e6,         1e9,    1e12,  -1e12, 1e18,
                                  1e38,   1e39, 1e207, 1e308, kInf, -kInf,        1e-308, 1e-12, 3.3e7, 1.5e9,
                                  -3e207, 720,  7.0,   99.0,  -kPi, std::nan(""), 5e-324, 500.0, 1e4,   1e15};
    return odd[below(odd.size())];
  }
  std::size_t below(std::size_t count) { return rng_() % count; }
  void flip_bit(std::string& content, std::size_t at) {
    content[at] = static_cast<char>(content[at] ^ static_cast<char>(1U << below(8)));
  }

 private:
  void change_word(std::string& content) {
    const auto words = header_words(content);
    if (words.empty()) return;
    const auto [at, length] = words[below(words.size())];
    static const std::vector<std::string> odd{
        "0",      "-1",  "1e6", "1e12", "1e308", "nan", "inf",        "-inf",
        "1e-308", "2",   "1e9", "-1e6", "60",    "181", "4294967296", "99999999999999999999",
        "-",      "cm",  "mm",  "rad",  "deg",   "x",   "#",          "",
        "-3e207", "1e18"};
    content.replace(at, length, odd[below(odd.size())]);
  }

  /// Changes a byte, a bit, or a number of 4 or 8 bytes in the header of a binary object.
  void change_bytes(std::string& content, bool is_text) {
    if (content.size() < 16) return;
    const std::size_t at = below(content.size() - 8);
    const std::size_t kind = is_text ? below(2) : below(4);
    if (kind == 0) flip_bit(content, at);
    if (kind == 1) content[at] = static_cast<char>(below(256));
    const double number = odd_number();
    const auto single = static_cast<float>(number);
    if (kind == 2) std::memcpy(content.data() + at, &single, sizeof single);
    if (kind == 3) std::memcpy(content.data() + at, &number, sizeof number);
  }

  void cut_or_double(std::string& content) {
    if (content.empty()) return;
    const std::size_t at = below(content.size());
    const std::size_t length = below(content.size() - at) + 1;
    if (below(2) == 0) {
      content.resize(at);
    } else {
      content.insert(at, std::string(content, at, length));
    }
  }

  std::mt19937 rng_;
};

/// Ends a run that does not end by itself, and says which it was.
class Watch {
 public:
  Watch() { std::signal(SIGALRM, on_alarm); }
  ~Watch() { ::alarm(0); }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;
  void start(int number) {
    running = number;
    ::alarm(kLongest_s);
  }

 private:
  static void on_alarm(int /*signal*/) {
    char text[] = "mutation 00000000 does not end\n";
    for (int digit = 16, left = running; digit > 8; --digit, left /= 10)
      text[digit] = static_cast<char>('0' + left % 10);
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text, sizeof text - 1);
    std::_Exit(1);
  }
  static inline volatile std::sig_atomic_t running = 0;
};

long peak_KiB() {
  struct rusage usage {};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

TEST(MutatedLogs, AreMappedOrRefused) {
  const TempFolder folder;
  const std::vector<Sample> originals = samples(folder);
  for (const Sample& sample : originals) {
    ASSERT_EQ(test::read_and_map(folder.write("a.log", sample.content)), Outcome::kMapped) << sample.name;
  }
  const long before_KiB = peak_KiB();
  Watch watch;
  int num_mapped = 0;
  const int count = num_mutations();
  for (int i = 0; i < count; ++i) {
    const Sample& sample = originals[static_cast<std::size_t>(i) % originals.size()];
    const std::string path = folder.write("a.log", Mutator(static_cast<unsigned>(i)).mutated(sample));
    SCOPED_TRACE("mutation " + std::to_string(i) + " of " + sample.name);
    watch.start(i);
    EXPECT_NO_THROW(num_mapped += test::read_and_map(path) == Outcome::kMapped ? 1 : 0);
  }
  // Neither outcome is rare, else the mutations would be too weak or too strong to tell anything.
  EXPECT_GT(num_mapped, count / 10);
  EXPECT_LT(num_mapped, count * 9 / 10);
  EXPECT_LT(peak_KiB() - before_KiB, kMostGrowth_KiB);
}

class MutatedStates : public testing::Test {
 protected:
  MutatedStates() { options_.run.threads = 1; }

  void map_with(StateOpening opening, std::size_t& num_resumed) {
    MatchCacheFile state(path_, opening, log_, options_);
    num_resumed = state.num_resumed();
    MappingEvents observer;
    map_log(log_, options_, observer, &state);
  }

  /// The place where the numbers of a candidate begin, and the record that it belongs to.
  struct Place {
    std::size_t record;
    std::size_t numbers;
  };
  static std::vector<Place> candidates_of(const std::string& content) {
    std::vector<Place> places;
    std::uint32_t text_size = u32_at(content, 16);
    for (std::size_t at = 20 + text_size + 4; at + kRecordHeadBytes < content.size();) {
      const std::size_t end = at + kRecordHeadBytes + u32_at(content, at);
      for (std::size_t h = at + kRecordHeadBytes + 24; h < end; h += 208) places.push_back({at, h});
      at = end;
    }
    return places;
  }

  static void mend_checksum(std::string& content, std::size_t record) {
    const std::uint32_t checksum =
        checksum_of(std::string_view(content).substr(record + kRecordHeadBytes, u32_at(content, record)));
    std::memcpy(content.data() + record + 4, &checksum, sizeof checksum);
  }

  TempFolder folder_;
  std::string path_ = folder_.path("run.state");
  Log log_ = walk(5, 0.6);
  MappingOptions options_;
};

TEST_F(MutatedStates, AreMappedWithWhateverTheySay) {
  std::size_t num_whole = 0;
  map_with(StateOpening::kCreate, num_whole);
  const std::string whole = test::read_file(path_);
  map_with(StateOpening::kResume, num_whole);
  const std::vector<Place> places = candidates_of(whole);
  ASSERT_GT(num_whole, 1U);
  ASSERT_GT(places.size(), num_whole);
  Watch watch;
  std::size_t num_refused = 0;
  const int count = num_mutations() / 4;
  for (int i = 0; i < count; ++i) {
    Mutator mutator(static_cast<unsigned>(i));
    std::string content = whole;
    const Place place = places[mutator.below(places.size())];
    const std::size_t at = place.numbers + 8 * mutator.below(26);
    if (mutator.below(3) == 0) {
      mutator.flip_bit(content, at + mutator.below(8));
    } else {
      const double number = mutator.odd_number();
      std::memcpy(content.data() + at, &number, sizeof number);
    }
    mend_checksum(content, place.record);
    folder_.write("run.state", content);
    SCOPED_TRACE("mutation " + std::to_string(i));
    watch.start(i);
    std::size_t num_resumed = 0;
    EXPECT_NO_THROW(map_with(StateOpening::kResume, num_resumed));
    num_refused += num_resumed < num_whole ? 1 : 0;
  }
  EXPECT_GT(num_refused, static_cast<std::size_t>(count) / 4);
}

}  // namespace
}  // namespace shapemap
