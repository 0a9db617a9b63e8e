// SPDX-License-Identifier: GPL-3.0-or-later
#include "mrpt_rbpf.hpp"

#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/random.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/slam/CMetricMapBuilderRBPF.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "io/rawlog.hpp"
#include "motions.hpp"
#include "shapemap/core/errors.hpp"
#include "shapemap/matching/match_probability.hpp"

namespace shapemap::baselines {
namespace {

/// These are the settings of MRPT's gridmapping_optimal_sampling.ini, except that all scans are used, and that beams
/// without a return clear no space: readings that are no returns for shapemap are none here, damaged ones too.
constexpr const char* kSettings = R"([Filter]
PF_algorithm = 3
adaptiveSampleSize = 0
resamplingMethod = 0
BETA = 0.50
powFactor = 0.01
pfOptimalProposal_mapSelection = 0
insertionLinDistance = -1
insertionAngDistance_deg = -1
localizeLinDistance = -1
localizeAngDistance_deg = -1
occupancyGrid_count = 1
pointsMap_count = 0
likelihoodMapSelection = -1
[Filter_occupancyGrid_00_insertOpts]
mapAltitude = 0
useMapAltitude = 0
maxOccupancyUpdateCertainty = 0.60
considerInvalidRangesAsFreeSpace = 0
minLaserScanNoiseStd = 0.001
wideningBeamsWithDistance = 0
[Filter_occupancyGrid_00_likelihoodOpts]
likelihoodMethod = 4
LF_decimation = 5
LF_stdHit = 0.20
LF_maxCorrsDistance = 0.30
LF_zHit = 0.999
LF_zRandom = 0.001
LF_maxRange = 30
LF_alternateAverageMethod = 0
enableLikelihoodCache = 1
)";

/// Each particle has a map of its own, with a byte a cell and eight for likelihoods: 3.6 GB.
constexpr double kMaxCells = 4e8;

using Filter = mrpt::slam::CMetricMapBuilderRBPF;

Filter::TConstructionOptions settings_of(const RbpfOptions& options) {
  validate(options);
  mrpt::config::CConfigFileMemory settings{std::string(kSettings)};
  settings.write("Filter", "sampleSize", options.particles);
  settings.write("Filter", "pfAuxFilterOptimal_MaximumSearchSamples", options.samples);
  settings.write("Filter_occupancyGrid_00_creationOpts", "resolution", options.cell_m);
  settings.write("Filter_occupancyGrid_00_insertOpts", "maxDistanceInsertion", options.longest_beam_m);
  Filter::TConstructionOptions construction;
  construction.loadFromConfigFile(settings, "Filter");
  construction.PF_options.loadFromConfigFile(settings, "Filter");
  construction.verbosity_level = mrpt::system::LVL_ERROR;
  return construction;
}

/// MRPT's builder makes a covariance of its own for a movement in 2D and keeps that of one in 3D. Coordinates that the
/// motion lacks get next to no deviation, but some, so that the matrix stays regular.
mrpt::obs::CActionRobotMovement3D action_of(const Motion& motion) {
  constexpr double kNone = 1e-12;
  const Pose2& pose = motion.previous_from_this;
  mrpt::obs::CActionRobotMovement3D action;
  action.poseChange.mean = mrpt::poses::CPose3D(pose.x_m, pose.y_m, 0.0, pose.theta_rad, 0.0, 0.0);
  action.poseChange.cov.setDiagonal(6, kNone);
  constexpr int kPlace[3] = {0, 1, 3};  // x, y, yaw among x, y, z, yaw, pitch, roll
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      action.poseChange.cov(kPlace[i], kPlace[j]) = motion.covariance(i, j) + (i == j ? kNone : 0.0);
    }
  }
  return action;
}

mrpt::obs::CSensoryFrame frame_of(const Scan& scan) {
  const std::string bytes = frame_to_rawlog(scan);
  mrpt::io::CMemoryStream stream;
  stream.assignMemoryNotOwn(bytes.data(), bytes.size());
  mrpt::obs::CSensoryFrame frame;
  mrpt::serialization::archiveFrom(stream) >> frame;
  return frame;
}

class MrptRbpf : public SlamMethod {
 public:
  MrptRbpf(const RbpfOptions& options, int seed) : options_(options), filter_(settings_of(options)) {
    mrpt::random::getRandomGenerator().randomize(static_cast<std::uint32_t>(seed));
    filter_.mapPDF.setVerbosityLevel(mrpt::system::LVL_ERROR);  // it warns on standard output
    filter_.initialize();
  }

  void add(const Scan& scan, const Motion& motion) override {
    const Pose2 way = entries_.empty() ? Pose2{} : motion.previous_from_this;
    since_update_ = entries_.empty() ? Motion{} : compose(since_update_, motion);
    if (!entries_.empty() && is_small(since_update_)) {
      since_entry_ = since_entry_ * way;
      entries_.push_back({path_length() - 1, since_entry_});
      return;
    }
    check_size(since_update_.previous_from_this);
    mrpt::obs::CActionCollection actions;
    actions.insert(action_of(since_update_));
    since_update_ = {};
    mrpt::obs::CSensoryFrame frame = frame_of(scan);
    const std::size_t length_before = path_length();
    filter_.processActionObservation(actions, frame);
    // The filter waits with a scan that has no return, and adds its motion to the next one.
    since_entry_ = path_length() > length_before ? Pose2{} : since_entry_ * way;
    entries_.push_back({path_length() - 1, since_entry_});
  }

  std::vector<Pose2> map_from_robot() const override {
    std::deque<mrpt::math::TPose3D> path;
    filter_.getCurrentMostLikelyPath(path);
    std::vector<Pose2> poses;
    for (const Entry& entry : entries_) {
      const mrpt::math::TPose3D& pose = path.at(entry.index);
      poses.push_back(Pose2{pose.x, pose.y, pose.yaw} * entry.entry_from_this);
    }
    return poses;
  }

 private:
  /// An entry tells where a scan stands on the paths of the particles.
  struct Entry {
    std::size_t index = 0;
    Pose2 entry_from_this;
  };

  bool is_small(const Motion& motion) const {
    const Pose2& pose = motion.previous_from_this;
    return pose.translation().norm() < options_.update_m && std::abs(pose.theta_rad) < options_.update_rad &&
           worst_deviation_m(motion.covariance) < 0.5 * options_.update_m;
  }

  std::size_t path_length() const { return filter_.mapPDF.m_particles.front().d->robotPath.size(); }

  /// Checks the size, since MRPT's maps grow to whatever a particle sees.
  void check_size(const Pose2& way) const {
    double left_m = 0.0;
    double right_m = 0.0;
    double bottom_m = 0.0;
    double top_m = 0.0;
    for (const auto& particle : filter_.mapPDF.m_particles) {
      const auto grid = particle.d->mapTillNow.mapByClass<mrpt::maps::COccupancyGridMap2D>();
      const mrpt::math::TPose3D& last = particle.d->robotPath.back();
      const Point2 next = Pose2{last.x, last.y, last.yaw} * way.translation();
      left_m = std::min({left_m, static_cast<double>(grid->getXMin()), next.x() - options_.longest_beam_m});
      right_m = std::max({right_m, static_cast<double>(grid->getXMax()), next.x() + options_.longest_beam_m});
      bottom_m = std::min({bottom_m, static_cast<double>(grid->getYMin()), next.y() - options_.longest_beam_m});
      top_m = std::max({top_m, static_cast<double>(grid->getYMax()), next.y() + options_.longest_beam_m});
    }
    const double cells = (right_m - left_m) * (top_m - bottom_m) / (options_.cell_m * options_.cell_m);
    if (cells * options_.particles <= kMaxCells) return;  // written so that NaN fails
    throw CannotGoOn("the particles' maps would need too much memory");
  }

  RbpfOptions options_;
  Filter filter_;
  std::vector<Entry> entries_;
  Pose2 since_entry_;
  Motion since_update_;
};

}  // namespace

std::unique_ptr<SlamMethod> make_mrpt_rbpf(const RbpfOptions& options, int seed) {
  return std::make_unique<MrptRbpf>(options, seed);
}

}  // namespace shapemap::baselines
