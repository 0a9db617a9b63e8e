// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/shape/range_image.hpp"

#include <algorithm>
#include <cmath>

#include "shapemap/scan/returns.hpp"

namespace shapemap {
namespace {

/// A point farther from its segment than this is not on it; its surface is assumed to face the sensor.
constexpr double kOnSegment_m = 0.10;

/// Beams that graze a surface leave a footprint of at most this many times their width.
constexpr double kLongestFootprint = 10.0;

/// The bearings of the beams run counterclockwise from `first_rad` on, as seen from above.
struct Bearings {
  double first_rad = 0.0;
  double step_rad = 0.0;
  std::size_t count = 0;
};

Bearings bearings_of_even_beams(const Sweep& sweep, bool upside_down) {
  const double first_rad = sweep.beam_angle_rad(0);
  const double last_rad = sweep.beam_angle_rad(sweep.ranges_m.size() - 1);
  const double lowest_rad = upside_down ? std::min(-first_rad, -last_rad) : std::min(first_rad, last_rad);
  return {wrap_angle(lowest_rad), std::abs(sweep.angle_step_rad), sweep.ranges_m.size()};
}

/// Returns bearings, one typical step apart, that cover all beams within at most a full turn.
Bearings bearings_of_uneven_beams(const Sweep& sweep, bool upside_down) {
  const auto [lowest, highest] = std::minmax_element(sweep.beam_angles_rad.begin(), sweep.beam_angles_rad.end());
  const double span_rad = *highest - *lowest;
  const double step_rad = std::abs(sweep.angle_step_rad);
  if (!(step_rad > 0.0)) return {};
  const double in_turn = std::max(1.0, std::round(2.0 * kPi / step_rad));
  Bearings bearings;
  bearings.first_rad = wrap_angle(upside_down ? -*highest : *lowest);
  bearings.step_rad = step_rad;
  bearings.count = static_cast<std::size_t>(std::min(in_turn, std::round(span_rad / step_rad) + 1.0));
  if (span_rad + step_rad > 2.0 * kPi - 0.5 * step_rad) {
    bearings.step_rad = 2.0 * kPi / in_turn;
    bearings.count = static_cast<std::size_t>(in_turn);
  }
  return bearings;
}

/// Seen from above, the angles of both kinds of beams run clockwise where the sensor is upside down.
Bearings bearings_of(const Sweep& sweep) {
  const bool upside_down = is_upside_down(sweep.robot_from_sensor);
  return sweep.is_evenly_spaced() ? bearings_of_even_beams(sweep, upside_down)
                                  : bearings_of_uneven_beams(sweep, upside_down);
}

Point2 normal_at(const SweepShape& shape, std::size_t point, const Point2& to_sensor) {
  const int closest = shape.polylines.closest_segment[point];
  if (closest < 0) return to_sensor;
  const LineSegment& segment = shape.polylines.segments[static_cast<std::size_t>(closest)];
  if (segment.distance_m(shape.scan_points[point].p_m) > kOnSegment_m) return to_sensor;
  const Point2 along = segment.direction();
  return {-along.y(), along.x()};  // counterclockwise scans have the sensor to their left
}

/// Puts returns into the beams of an image. Even beams have at most one return each. Where uneven beams meet in one
/// bearing, the return nearest to its middle stays; a bearing that none falls into takes a return less than a step
/// away.
class ImageFilling {
 public:
  ImageFilling(const Sweep& sweep, const SweepShape& shape, const Pose2& robot_from_sensor, RangeImage& image)
      : shape_(shape), robot_from_sensor_(robot_from_sensor), image_(image) {
    if (!sweep.is_evenly_spaced()) steps_off_.assign(image.beams.size(), kReach_steps);
  }

  void add(std::size_t point) {
    const Point2 in_sensor_m = image_.sensor_from_robot * shape_.scan_points[point].p_m;
    const double bearing_rad = std::atan2(in_sensor_m.y(), in_sensor_m.x());
    const int middle = image_.beam_at(bearing_rad);
    if (steps_off_.empty()) {
      if (middle >= 0) set(point, in_sensor_m, static_cast<std::size_t>(middle));
      return;
    }
    for (const double aside : {-1.0, 0.0, 1.0}) {
      const int k = aside == 0.0 ? middle : image_.beam_at(bearing_rad + aside * image_.step_rad);
      if (k < 0) continue;
      const auto beam = static_cast<std::size_t>(k);
      const double middle_rad = image_.first_bearing_rad + static_cast<double>(k) * image_.step_rad;
      const double steps = angle_between(bearing_rad, middle_rad) / image_.step_rad;
      if (steps >= steps_off_[beam]) continue;
      steps_off_[beam] = steps;
      set(point, in_sensor_m, beam);
    }
  }

 private:
  static constexpr double kReach_steps = 0.75;

  void set(std::size_t point, const Point2& in_sensor_m, std::size_t index) {
    const Point2& hit_m = shape_.scan_points[point].p_m;
    RangeImage::Beam& beam = image_.beams[index];
    beam.range_m = in_sensor_m.norm();
    beam.hit_m = hit_m;
    const Point2 to_sensor = (robot_from_sensor_.translation() - hit_m) / beam.range_m;
    beam.normal = normal_at(shape_, point, to_sensor);
    const double incidence = std::max(1.0 / kLongestFootprint, std::abs(beam.normal.dot(to_sensor)));
    beam.footprint_m = 0.5 * beam.range_m * image_.step_rad / incidence;
  }

  const SweepShape& shape_;
  const Pose2& robot_from_sensor_;
  RangeImage& image_;
  /// distance of each bearing's return from its middle, in steps; empty for even beams
  std::vector<double> steps_off_;
};

}  // namespace

int RangeImage::beam_at(double bearing_rad) const {
  const double per_rad = 1.0 / step_rad;
  const double beams_in_turn = 2.0 * kPi * per_rad;
  double from_first_rad = bearing_rad - first_bearing_rad;
  if (std::abs(from_first_rad) > 2.0 * kPi) from_first_rad = wrap_angle(from_first_rad);
  double beam = from_first_rad * per_rad + 0.5;  // the beam is less than a turn away, so adding one turn is enough
  if (beam < 0.0) beam += beams_in_turn;
  if (beam >= beams_in_turn) beam -= beams_in_turn;
  const auto count = static_cast<double>(beams.size());
  if (beam < count) return static_cast<int>(beam);
  // Rounding leaves no gap in a full circle.
  return beams_in_turn - count < 1e-6 ? static_cast<int>(beams.size()) - 1 : -1;
}

RangeImage range_image(const Sweep& sweep, const SweepShape& shape) {
  RangeImage image;
  const Pose2 robot_from_sensor = robot_from_sensor2(sweep);
  image.sensor_from_robot = inverse(robot_from_sensor);
  if (sweep.ranges_m.empty()) return image;
  const Bearings bearings = bearings_of(sweep);
  image.step_rad = bearings.step_rad;
  if (!(image.step_rad > 0.0)) return image;
  image.first_bearing_rad = bearings.first_rad;
  image.beams.resize(bearings.count);
  ImageFilling filling(sweep, shape, robot_from_sensor, image);
  for (std::size_t i = 0; i < shape.scan_points.size(); ++i) filling.add(i);
  return image;
}

}  // namespace shapemap
