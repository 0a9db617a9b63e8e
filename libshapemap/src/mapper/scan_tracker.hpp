// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>

#include "motion/constant_velocity.hpp"
#include "shapemap/inference/robust_options.hpp"
#include "shapemap/matching/match_search.hpp"

namespace shapemap {

/// Tracks a sensor that moves little from scan to scan, as in recordings at full rate, and finds the scans that a
/// keyframe can replace. A scan in any doubt becomes a keyframe, because keyframes are matched without an initial
/// guess.
class ScanTracker {
 public:
  explicit ScanTracker(const RobustOptions& options) : options_(options) {}

  /// Compares the following scans to `keyframe`; null starts another session.
  void start(std::shared_ptr<const ScanView> keyframe);

  /// Must be called after scans without shape, during which any motion is possible.
  void forget_motion() { step_.reset(); }

  /// Returns the pose of the scan in the frame of the keyframe; nothing when the keyframe cannot replace it.
  std::optional<MatchCandidate> follow(const ScanView& view);

  /// Returns the pose that was expected of the last scan, in the frame of its keyframe; nothing unless scans follow
  /// each other closely.
  const std::optional<ExpectedPose>& expected() const { return expected_; }

 private:
  void go_on_by(const Pose2& step);
  std::optional<MatchCandidate> followed(const ScanView& view) const;
  std::optional<MatchCandidate> searched(const ScanView& view) const;

  const RobustOptions& options_;
  std::shared_ptr<const ScanView> keyframe_;
  Pose2 last_;                 ///< pose of the scan before, in the frame of the keyframe
  std::optional<Pose2> step_;  ///< last motion from one scan to the next, where it is known
  ConstantVelocityPrior expectation_;
  std::optional<ExpectedPose> expected_;
  double attached_ = 0.0;  ///< share of the recent scans that were attached to a keyframe
};

}  // namespace shapemap
