// SPDX-License-Identifier: GPL-3.0-or-later
#include "scan_tracker.hpp"

#include <algorithm>
#include <cmath>

#include "mapper_numbers.hpp"
#include "shapemap/matching/match_probability.hpp"
#include "shapemap/matching/pair_evidence.hpp"

namespace shapemap {
void ScanTracker::start(std::shared_ptr<const ScanView> keyframe) {
  keyframe_ = std::move(keyframe);
  if (!keyframe_) {
    forget_motion();
    expectation_ = {};
    attached_ = 0.0;
  }
  last_ = {};
  attached_ *= kMapper.tracking.memory;
}

std::optional<MatchCandidate> ScanTracker::follow(const ScanView& view) {
  expected_.reset();
  if (!keyframe_ || options_.keyframes.step_m <= 0.0) return std::nullopt;
  if (attached_ > kMapper.tracking.dense) expected_ = step_ ? expectation_.at(last_ * *step_) : ExpectedPose{last_};
  std::optional<MatchCandidate> pose = followed(view);
  if (!pose && attached_ > kMapper.tracking.dense) pose = searched(view);
  if (!pose) {
    forget_motion();
    return std::nullopt;
  }
  go_on_by(inverse(last_) * pose->ref_from_query);
  if (!is_within(pose->ref_from_query, options_.keyframes.near())) return std::nullopt;
  last_ = pose->ref_from_query;
  attached_ = 1.0 - kMapper.tracking.memory * (1.0 - attached_);
  return pose;
}

/// Learns from a step of the sensor. After a jump, as where scans were lost, any motion is possible.
void ScanTracker::go_on_by(const Pose2& step) {
  if (!is_within(step, kMapper.tracking.longest_step)) return forget_motion();
  if (step_ && !is_within(step, kMapper.tracking.stands)) expectation_.learn(inverse(*step_) * step);
  step_ = step;
}

/// Refines the pose of the last scan, and the pose at which the motion goes on, and returns the better.
std::optional<MatchCandidate> ScanTracker::followed(const ScanView& view) const {
  MatchCandidate best = refined_candidate(*keyframe_, view, last_, options_.matcher.search);
  if (step_) {
    MatchCandidate onward = refined_candidate(*keyframe_, view, last_ * *step_, options_.matcher.search);
    if (onward.score > best.score) best = std::move(onward);
  }
  const Pose2 step = inverse(last_) * best.ref_from_query;
  if (!shows_the_same(best) || !is_within(step, kMapper.tracking.longest_step)) return std::nullopt;
  return best;
}

std::optional<MatchCandidate> ScanTracker::searched(const ScanView& view) const {
  const std::vector<MatchCandidate> poses = find_candidates(*keyframe_, view, options_.matcher.search);
  if (poses.empty()) return std::nullopt;
  const double probability = match_probability(poses.front(), lead_of_first(poses));
  if (probability < options_.matcher.confidence.sure_probability) return std::nullopt;
  return poses.front();
}

}  // namespace shapemap
