// SPDX-License-Identifier: GPL-3.0-or-later
#include "mrpt_icp.hpp"

#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/slam/CMetricMapBuilderICP.h>

#include "shapemap/core/errors.hpp"

namespace shapemap::baselines {
namespace {

/// These are the settings of MRPT's icp-slam_demo_classic.ini.
constexpr const char* kSettings = R"([ICP]
ICP_algorithm = icpClassic
maxIterations = 80
minAbsStep_trans = 1e-6
minAbsStep_rot = 1e-6
thresholdAng_DEG = 5
ALFA = 0.8
smallestThresholdDist = 0.05
onlyUniqueRobust = true
corresponding_points_decimation = 1
[Map]
matchAgainstTheGrid = 0
pointsMap_count = 1
occupancyGrid_count = 0
likelihoodMapSelection = -1
[Map_pointsMap_00_insertOpts]
minDistBetweenLaserPoints = 0.05
fuseWithExisting = false
isPlanarMap = 1
)";

/// MRPT wants increasing times, and logs may repeat them; they have no other use here.
mrpt::Clock::time_point time_of(std::size_t index) {
  return mrpt::Clock::fromDouble(1e6 + 0.1 * static_cast<double>(index));
}

class MrptIcp : public SlamMethod {
 public:
  MrptIcp(const IcpOptions& options, const ReturnOptions& returns) : returns_(returns) {
    validate(options);
    const mrpt::config::CConfigFileMemory settings{std::string(kSettings)};
    builder_.setVerbosityLevel(mrpt::system::LVL_ERROR);
    builder_.ICP_params.loadFromConfigFile(settings, "ICP");
    builder_.ICP_params.thresholdDist = options.reach_m;
    builder_.ICP_options.loadFromConfigFile(settings, "Map");
    builder_.ICP_options.insertionLinDistance = options.insertion_m;
    builder_.ICP_options.insertionAngDistance = options.insertion_rad;
    // Every scan gets a pose of its own, however near it is to the one before.
    builder_.ICP_options.localizationLinDistance = 0.0;
    builder_.ICP_options.localizationAngDistance = 0.0;
    builder_.ICP_options.minICPgoodnessToAccept = options.min_goodness;
    builder_.initialize();
  }

  void add(const Scan& scan, const Motion& motion) override {
    if (!poses_.empty()) odometry_from_robot_ = odometry_from_robot_ * motion.previous_from_this;
    auto odometry = mrpt::obs::CObservationOdometry::Create();
    odometry->timestamp = time_of(2 * poses_.size());
    odometry->odometry = {odometry_from_robot_.x_m, odometry_from_robot_.y_m, odometry_from_robot_.theta_rad};
    builder_.processObservation(odometry);

    if (const auto points = points_of(scan)) builder_.processObservation(points);
    const mrpt::poses::CPose3D pose = builder_.getCurrentPoseEstimation()->getMeanVal();
    poses_.push_back({pose.x(), pose.y(), pose.yaw()});
  }

  std::vector<Pose2> map_from_robot() const override { return poses_; }

 private:
  /// Puts all sweeps together, so that a scan is matched as one; null when there is no return.
  mrpt::obs::CObservationPointCloud::Ptr points_of(const Scan& scan) const {
    auto points = mrpt::maps::CSimplePointsMap::Create();
    for (const Sweep& sweep : scan.sweeps) {
      for (const Return& hit : returns_in_robot(sweep, returns_)) {
        points->insertPoint(static_cast<float>(hit.p_in_robot_m.x()), static_cast<float>(hit.p_in_robot_m.y()));
      }
    }
    if (points->empty()) return nullptr;
    auto observation = mrpt::obs::CObservationPointCloud::Create();
    observation->pointcloud = points;
    observation->sensorLabel = "position";
    observation->timestamp = time_of(2 * poses_.size() + 1);
    return observation;
  }

  ReturnOptions returns_;
  mrpt::slam::CMetricMapBuilderICP builder_;
  Pose2 odometry_from_robot_;
  std::vector<Pose2> poses_;
};

}  // namespace

std::unique_ptr<SlamMethod> make_mrpt_icp(const IcpOptions& options, const ReturnOptions& returns) {
  return std::make_unique<MrptIcp>(options, returns);
}

}  // namespace shapemap::baselines
