// SPDX-License-Identifier: GPL-3.0-or-later
#include "matching/beam_lookup.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace shapemap {
namespace {

RangeImage empty_image(double first_bearing_rad, double step_rad, std::size_t num_beams) {
  RangeImage image;
  image.first_bearing_rad = first_bearing_rad;
  image.step_rad = step_rad;
  image.beams.resize(num_beams);
  return image;
}

void expect_same_beam(const RangeImage& image, const Point2& p_m) {
  const double near_rad = approximate_bearing_rad(p_m.x(), p_m.y());
  EXPECT_EQ(beam_near(image, near_rad, p_m), image.beam_at(std::atan2(p_m.y(), p_m.x())))
      << p_m.transpose() << ", " << image.beams.size() << " beams from " << image.first_bearing_rad;
}

TEST(BeamLookup, ApproximatesAllBearings) {
  for (int k = -200000; k <= 200000; ++k) {
    const double bearing_rad = k * kPi / 200000;
    const Point2 p_m = (0.1 + std::abs(k % 7)) * Point2(std::cos(bearing_rad), std::sin(bearing_rad));
    EXPECT_NEAR(approximate_bearing_rad(p_m.x(), p_m.y()), std::atan2(p_m.y(), p_m.x()), kBearingError_rad);
  }
}

TEST(BeamLookup, FindsTheBeamOfTheExactBearing) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> bearing_rad(-4 * kPi, 4 * kPi);
  std::uniform_real_distribution<double> place_m(-20.0, 20.0);
  for (int round = 0; round < 2000; ++round) {
    const double step_rad = std::uniform_real_distribution<double>(0.05, 5.0)(rng) * kDegree;
    const auto most = static_cast<std::size_t>(2 * kPi / step_rad);
    const RangeImage image =
        empty_image(bearing_rad(rng), step_rad, std::uniform_int_distribution<std::size_t>(1, most)(rng));
    for (int look = 0; look < 30; ++look) expect_same_beam(image, {place_m(rng), place_m(rng)});
  }
}

TEST(BeamLookup, IsExactAtTheBordersOfBeams) {
  for (const std::size_t num_beams : {1U, 2U, 7U, 180U, 181U, 360U, 361U, 1081U}) {
    for (const double first_rad : {-kPi, -0.75 * kPi, -0.5 * kPi, 0.0, 1.0}) {
      for (const double step_rad :
           {0.25 * kDegree, 0.5 * kDegree, kDegree, 2.0 * kPi / static_cast<double>(num_beams)}) {
        const RangeImage image = empty_image(first_rad, step_rad, num_beams);
        for (int border = -3; border < static_cast<int>(num_beams) + 3; ++border) {
          for (const double off_rad : {-3e-8, -1e-8, -1e-10, -1e-15, 0.0, 1e-15, 1e-10, 1e-8, 3e-8}) {
            const double at_rad = first_rad + (border + 0.5) * step_rad + off_rad;
            expect_same_beam(image, 3.0 * Point2(std::cos(at_rad), std::sin(at_rad)));
          }
        }
      }
    }
  }
}

TEST(BeamLookup, OfTheSensorItselfAndOfNoImageIsThatOfTheBearing) {
  for (const Point2& p_m : {Point2(0.0, 0.0), Point2(-0.0, 0.0), Point2(0.0, -0.0), Point2(-0.0, -0.0),
                            Point2(1.0, 0.0), Point2(-1.0, 0.0), Point2(-1.0, -0.0), Point2(0.0, 1.0)}) {
    expect_same_beam(empty_image(-kPi, kDegree, 360), p_m);
    expect_same_beam(empty_image(-0.5 * kPi, kDegree, 181), p_m);
    EXPECT_EQ(beam_near({}, approximate_bearing_rad(p_m.x(), p_m.y()), p_m), -1);
  }
}

}  // namespace
}  // namespace shapemap
