// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/shape/range_image.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "shapemap/scan/beam_angles.hpp"
#include "shapemap/scan/returns.hpp"
#include "support/matchers.hpp"
#include "support/views.hpp"

namespace shapemap {
namespace {

using test::IsNearAngle;
using test::IsNearPoint;

RangeImage image_of(const Sweep& sweep) { return range_image(sweep, sweep_shape(sweep, 0, {}, {}, {})); }

RangeImage empty_image(double first_bearing_rad, double step_rad, std::size_t num_beams) {
  RangeImage image;
  image.first_bearing_rad = first_bearing_rad;
  image.step_rad = step_rad;
  image.beams.resize(num_beams);
  return image;
}

double bearing_rad(const RangeImage& image, std::size_t beam) {
  return image.first_bearing_rad + static_cast<double>(beam) * image.step_rad;
}

/// Returns how far the nearest of all beams points away from a bearing.
double off_nearest_rad(const RangeImage& image, double bearing) {
  double nearest_rad = 2.0 * kPi;
  for (std::size_t k = 0; k < image.beams.size(); ++k) {
    nearest_rad = std::min(nearest_rad, angle_between(bearing, bearing_rad(image, k)));
  }
  return nearest_rad;
}

void expect_nearest(const RangeImage& image, double bearing) {
  constexpr double kRounding_rad = 1e-9;
  const double off_rad = off_nearest_rad(image, bearing);
  const int beam = image.beam_at(bearing);
  if (std::abs(off_rad - 0.5 * image.step_rad) < kRounding_rad) return;  // the bearing is on the border of two beams
  if (off_rad > 0.5 * image.step_rad) {
    EXPECT_EQ(beam, -1) << bearing;
    return;
  }
  ASSERT_GE(beam, 0) << bearing;
  ASSERT_LT(beam, static_cast<int>(image.beams.size()));
  EXPECT_NEAR(angle_between(bearing, bearing_rad(image, static_cast<std::size_t>(beam))), off_rad, kRounding_rad);
}

TEST(RangeImage, FindsTheBeamThatASearchOfAllFinds) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> angle(-4 * kPi, 4 * kPi);
  for (int round = 0; round < 300; ++round) {
    const double step_rad = std::uniform_real_distribution<double>(0.1, 5.0)(rng) * kDegree;
    const auto most = static_cast<std::size_t>(2 * kPi / step_rad);
    const RangeImage image =
        empty_image(angle(rng), step_rad, std::uniform_int_distribution<std::size_t>(1, most)(rng));
    for (int i = 0; i < 30; ++i) expect_nearest(image, angle(rng));
  }
}

TEST(RangeImage, SeesAllAroundWithoutASeam) {
  std::mt19937 rng(2);
  std::uniform_real_distribution<double> angle(-4 * kPi, 4 * kPi);
  for (const std::size_t num_beams : {1U, 2U, 7U, 359U, 360U, 720U, 1081U, 4096U}) {
    const double step_rad = 2.0 * kPi / static_cast<double>(num_beams);
    for (int round = 0; round < 200; ++round) {
      const RangeImage image = empty_image(angle(rng), step_rad, num_beams);
      const double seam_rad = image.first_bearing_rad - 0.5 * step_rad;
      for (const double turn_rad : {-2.0 * kPi, 0.0, 2.0 * kPi}) {
        for (const double nudge_rad : {-1e-15, -1e-16, 0.0, 1e-16, 1e-15}) {
          const int beam = image.beam_at(seam_rad + turn_rad + nudge_rad);
          EXPECT_TRUE(beam == 0 || beam == static_cast<int>(num_beams) - 1) << beam << " of " << num_beams;
        }
      }
      expect_nearest(image, angle(rng));
    }
  }
}

TEST(RangeImage, WithTheFirstBearingTwiceFindsOneOfThem) {
  const RangeImage image = empty_image(-kPi, kDegree, 361);  // such scanners over 360 degrees include both ends
  for (int k = -720; k <= 720; ++k) expect_nearest(image, (k + 0.3) * kDegree);
}

struct Mounting {
  const char* name;
  double first_angle_rad;
  double angle_step_rad;
  MountPose robot_from_sensor;
};

class RangeImageOfMounting : public testing::TestWithParam<Mounting> {};

/// Every return is in one beam, which is the one that points at it.
TEST_P(RangeImageOfMounting, HasEveryReturnWhereItWasSeen) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<float> range_m(1.0F, 3.0F);
  Sweep sweep;
  sweep.first_angle_rad = GetParam().first_angle_rad;
  sweep.angle_step_rad = GetParam().angle_step_rad;
  sweep.max_range_m = 20.0;
  sweep.robot_from_sensor = GetParam().robot_from_sensor;
  sweep.nominal_heading_rad = 0.7;
  for (int k = 0; k < 180; ++k) sweep.ranges_m.push_back(k % 7 == 3 ? std::nanf("") : range_m(rng));
  const RangeImage image = image_of(sweep);
  ASSERT_EQ(image.beams.size(), sweep.ranges_m.size());

  std::size_t num_hits = 0;
  for (const RangeImage::Beam& beam : image.beams) num_hits += beam.range_m > 0.0 ? 1 : 0;
  const std::vector<Return> returns = returns_in_robot(sweep, {});
  EXPECT_EQ(num_hits, returns.size());
  for (const Return& r : returns) {
    const Point2 in_sensor_m = image.sensor_from_robot * r.p_in_robot_m;
    const double bearing = std::atan2(in_sensor_m.y(), in_sensor_m.x());
    const int k = image.beam_at(bearing);
    ASSERT_GE(k, 0);
    const RangeImage::Beam& beam = image.beams[static_cast<std::size_t>(k)];
    EXPECT_THAT(beam.hit_m, IsNearPoint(r.p_in_robot_m, 1e-12));
    EXPECT_NEAR(beam.range_m, r.range_m, 1e-9);
    EXPECT_THAT(bearing_rad(image, static_cast<std::size_t>(k)), IsNearAngle(bearing, 1e-9));
    EXPECT_GE(beam.footprint_m, 0.5 * beam.range_m * image.step_rad * (1.0 - 1e-12));
    EXPECT_NEAR(beam.normal.norm(), 1.0, 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Mountings, RangeImageOfMounting,
    testing::Values(Mounting{"Upright", -1.5, kDegree, {0.2, 0.1, 0.0, 0.3, 0.0, 0.0}},
                    Mounting{"Clockwise", 1.5, -kDegree, {0.2, 0.1, 0.0, 0.3, 0.0, 0.0}},
                    Mounting{"UpsideDown", -1.4, kDegree, {0.2, 0.1, 0.0, 0.3, 0.0, kPi}},
                    Mounting{"PitchedOver", -1.4, kDegree, {0.2, 0.1, 0.0, 0.3, kPi, 0.0}},
                    Mounting{"ClockwiseUpsideDown", 1.6, -kDegree, {0.2, 0.1, 0.0, 2.8, 0.0, kPi}},
                    Mounting{"FullCircle", -kPi, 2 * kDegree, {-0.3, 0.1, 0.0, -3.0, 0.0, 0.0}},
                    Mounting{"FullCircleClockwiseUpsideDown", 0.4, -2 * kDegree, {-0.3, 0.1, 0.0, -3.0, 0.0, kPi}}),
    [](const auto& mounting) { return mounting.param.name; });

TEST(RangeImage, NormalsOfWallsPointToTheSensor) {
  const Scan scan = test::scan_of(test::uneven_room(), {0.3, -0.2, 0.4});
  const RangeImage image = image_of(scan.sweeps[0]);
  int num_across = 0;
  for (const RangeImage::Beam& beam : image.beams) {
    ASSERT_GT(beam.range_m, 0.0);
    num_across += beam.normal.dot(-beam.hit_m) > 0.0 ? 1 : 0;
  }
  EXPECT_GE(num_across, 710) << "of 720; corners may be either way";
}

/// Beams that are moved a little off their even angles see the same: nearly every bearing has its return, and the
/// return of a beam is in the bearing that it fell into, or in the one beside it.
TEST(RangeImage, OfUnevenBeamsHasNearlyEveryBearing) {
  std::mt19937 rng(6);
  std::uniform_real_distribution<double> aside(-0.4, 0.4);
  for (const bool full_circle : {true, false}) {
    Sweep sweep;
    std::vector<double> angles_rad;
    for (int k = 0; k < (full_circle ? 360 : 180); ++k) {
      angles_rad.push_back((k - 90 + aside(rng)) * kDegree);
      sweep.ranges_m.push_back(2.0F);
    }
    std::shuffle(angles_rad.begin(), angles_rad.end(), rng);
    set_beam_angles(sweep, angles_rad);
    const RangeImage image = image_of(sweep);
    std::size_t num_hits = 0;
    for (std::size_t k = 0; k < image.beams.size(); ++k) {
      const RangeImage::Beam& beam = image.beams[k];
      if (beam.range_m <= 0.0) continue;
      ++num_hits;
      const double seen_rad = std::atan2(beam.hit_m.y(), beam.hit_m.x());
      EXPECT_LT(angle_between(seen_rad, bearing_rad(image, k)), 0.76 * image.step_rad);
    }
    EXPECT_GT(num_hits, image.beams.size() * 98 / 100);
    EXPECT_NEAR(static_cast<double>(image.beams.size()) * image.step_rad, full_circle ? 2 * kPi : kPi, 4 * kDegree);
  }
}

TEST(RangeImage, OfNoBeamsHasNone) {
  Sweep sweep;
  sweep.angle_step_rad = kDegree;
  EXPECT_TRUE(image_of(sweep).beams.empty());
  sweep.ranges_m = {1.0F};
  sweep.angle_step_rad = 0.0;
  EXPECT_TRUE(image_of(sweep).beams.empty());
}

/// Finds the beam as beam_at() defines it, by turning on until the bearing is there.
int beam_by_turning(const RangeImage& image, double bearing_rad) {
  const double beams_in_turn = 2.0 * kPi * (1.0 / image.step_rad);
  double beam = (bearing_rad - image.first_bearing_rad) * (1.0 / image.step_rad) + 0.5;
  while (beam < 0.0) beam += beams_in_turn;
  while (beam >= beams_in_turn) beam -= beams_in_turn;
  const auto count = static_cast<double>(image.beams.size());
  if (beam < count) return static_cast<int>(beam);
  return beams_in_turn - count < 1e-6 ? static_cast<int>(image.beams.size()) - 1 : -1;
}

TEST(RangeImage, BeamsAreFoundWithoutTurningOn) {
  std::mt19937 rng(11);
  std::uniform_real_distribution<double> bearing(-kPi, kPi);
  for (const auto& [step_rad, num_beams] :
       {std::pair{kDegree, 360}, {kDegree, 181}, {0.25 * kDegree, 1081}, {0.7, 9}}) {
    for (int i = 0; i < 2000; ++i) {
      const RangeImage image = empty_image(bearing(rng), step_rad, static_cast<std::size_t>(num_beams));
      const double bearing_rad = i % 7 == 0 ? image.first_bearing_rad + 0.5 * step_rad * i : bearing(rng);
      const double wrapped_rad = wrap_angle(bearing_rad);
      ASSERT_EQ(image.beam_at(wrapped_rad), beam_by_turning(image, wrapped_rad));
    }
  }
}

TEST(RangeImage, EveryBearingAndEveryStepEnds) {
  for (const double step_rad : {1e12, 1e308, 1e-300, 5e-324, 0.01}) {
    const RangeImage image = empty_image(0.3, step_rad, 20);
    for (const double bearing_rad : {0.0, 1e6, -1e18, 1e308, std::nan(""), HUGE_VAL}) {
      const int beam = image.beam_at(bearing_rad);
      EXPECT_TRUE(beam >= -1 && beam < 20) << step_rad << " " << bearing_rad;
    }
  }
  const RangeImage image = empty_image(0.0, kDegree, 360);
  EXPECT_EQ(image.beam_at(1000 * 2 * kPi + 90.2 * kDegree), 90);
  EXPECT_EQ(image.beam_at(-1000 * 2 * kPi + 90.2 * kDegree), 90);
}

}  // namespace
}  // namespace shapemap
