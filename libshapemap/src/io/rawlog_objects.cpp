// SPDX-License-Identifier: GPL-3.0-or-later
#include <mrpt/core/Clock.h>
#include <mrpt/core/exceptions.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose2D.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "mount_pose.hpp"
#include "rawlog.hpp"
#include "shapemap/scan/beam_angles.hpp"
#include "shapemap/scan/returns.hpp"

namespace shapemap {
namespace {

using mrpt::obs::CObservation2DRangeScan;

std::string serialised(const mrpt::serialization::CSerializable& object) {
  mrpt::io::CMemoryStream stream;
  mrpt::serialization::archiveFrom(stream) << object;
  return {static_cast<const char*>(stream.getRawBufferData()), stream.getTotalBytesCount()};
}

MountPose mount_from_mrpt(const mrpt::poses::CPose3D& pose) {
  MountPose mount{pose.x(), pose.y(), pose.z(), 0.0, 0.0, 0.0};
  pose.getYawPitchRoll(mount.yaw_rad, mount.pitch_rad, mount.roll_rad);
  return mount;
}

/// MRPT counts in ticks since the year 1601; tick 0 means "unknown".
mrpt::Clock::time_point mrpt_time(double timestamp_s) { return mrpt::Clock::fromDouble(timestamp_s); }

/// MRPT's beams lie symmetrically around the sensor's x axis, so that the middle of the sweep is turned there.
CObservation2DRangeScan::Ptr scan_to_mrpt(const Sweep& even_or_not, double timestamp_s) {
  const Sweep sweep = on_even_beams(even_or_not);
  const std::size_t num_beams = sweep.ranges_m.size();
  const double span_rad = sweep.angle_step_rad * (static_cast<double>(num_beams) - 1.0);
  const double middle_rad = sweep.first_angle_rad + span_rad / 2;
  const MountPose mount = mount_with_heading(sweep);

  auto out = CObservation2DRangeScan::Create();
  out->aperture = static_cast<float>(std::abs(span_rad));
  out->rightToLeft = sweep.angle_step_rad >= 0.0;
  if (sweep.max_range_m > 0.0) out->maxRange = static_cast<float>(sweep.max_range_m);
  out->sensorPose =
      mrpt::poses::CPose3D(mount.x_m, mount.y_m, mount.z_m, mount.yaw_rad, mount.pitch_rad, mount.roll_rad) +
      mrpt::poses::CPose3D(0.0, 0.0, 0.0, middle_rad, 0.0, 0.0);
  out->sensorLabel = sweep.sensor_label;
  out->timestamp = mrpt_time(timestamp_s);
  out->resizeScan(num_beams);
  const RangeLimits limits = range_limits(sweep, ReturnOptions{});
  for (std::size_t i = 0; i < num_beams; ++i) {
    const bool valid = is_return(sweep.ranges_m[i], limits);
    out->setScanRange(i, valid ? sweep.ranges_m[i] : out->maxRange);
    out->setScanRangeValidity(i, valid);
  }
  return out;
}

}  // namespace

RawlogScan scan_from_rawlog(std::string_view object) {
  CObservation2DRangeScan in;
  try {
    mrpt::io::CMemoryStream stream;
    stream.assignMemoryNotOwn(object.data(), object.size());
    mrpt::serialization::archiveFrom(stream) >> in;
  } catch (const std::exception& error) {
    throw std::runtime_error(error.what());
  }
  RawlogScan out;
  Sweep& sweep = out.sweep;
  const std::size_t num_beams = in.getScanSize();
  const double direction = in.rightToLeft ? 1.0 : -1.0;
  const double aperture_rad = in.aperture;
  sweep.first_angle_rad = -direction * aperture_rad / 2;
  if (num_beams > 1) sweep.angle_step_rad = direction * aperture_rad / static_cast<double>(num_beams - 1);
  sweep.max_range_m = std::isfinite(in.maxRange) && in.maxRange > 0.0F ? static_cast<double>(in.maxRange) : 0.0;
  sweep.robot_from_sensor = mount_from_mrpt(in.sensorPose);
  sweep.sensor_label = in.sensorLabel;
  sweep.ranges_m.reserve(num_beams);
  for (std::size_t i = 0; i < num_beams; ++i) {
    sweep.ranges_m.push_back(in.getScanRangeValidity(i) ? in.getScanRange(i) : std::numeric_limits<float>::quiet_NaN());
  }
  if (in.timestamp != INVALID_TIMESTAMP) out.timestamp_s = mrpt::Clock::toDouble(in.timestamp);
  return out;
}

std::string frame_to_rawlog(const Scan& scan) {
  mrpt::obs::CSensoryFrame frame;
  for (const Sweep& sweep : scan.sweeps) frame.insert(scan_to_mrpt(sweep, scan.timestamp_s));
  return serialised(frame);
}

std::string action_to_rawlog(const std::optional<Pose2>& previous_from_current, double timestamp_s) {
  mrpt::obs::CActionCollection actions;
  if (previous_from_current) {
    mrpt::obs::CActionRobotMovement2D movement;
    movement.timestamp = mrpt_time(timestamp_s);
    mrpt::obs::CActionRobotMovement2D::TMotionModelOptions model;
    model.modelSelection = mrpt::obs::CActionRobotMovement2D::mmGaussian;
    movement.computeFromOdometry(
        mrpt::poses::CPose2D(previous_from_current->x_m, previous_from_current->y_m, previous_from_current->theta_rad),
        model);
    actions.insert(movement);
  }
  return serialised(actions);
}

}  // namespace shapemap
