// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>

#include "motion/constant_velocity.hpp"
#include "shapemap/inference/robust_options.hpp"
#include "shapemap/matching/match_search.hpp"

namespace shapemap {

/// Follows a sensor that moves little from scan to scan, as in recordings at full rate, and says which of the scans a
/// keyframe can stand for. Any doubt makes a keyframe: those are aligned without a guess.
class ScanTracker {
 public:
  explicit ScanTracker(const RobustOptions& options) : options_(options) {}

  /// From here on, scans are compared to `keyframe`; with none, another log starts.
  void start(std::shared_ptr<const ScanView> keyframe);

  /// After scans that tell nothing: the motion may have been any.
  void forget_motion() { step_.reset(); }

  /// The pose of a scan that the keyframe can stand for, in its frame.
  std::optional<MatchCandidate> follow(const ScanView& view);

  /// Where the scan last asked about was to be expected, in the frame of the keyframe then: only where scans follow
  /// each other closely.
  const std::optional<ExpectedPose>& expected() const { return expected_; }

 private:
  void go_on_by(const Pose2& step);
  std::optional<MatchCandidate> followed(const ScanView& view) const;
  std::optional<MatchCandidate> searched(const ScanView& view) const;

  const RobustOptions& options_;
  std::shared_ptr<const ScanView> keyframe_;
  Pose2 last_;                 ///< of the scan before, in the frame of the keyframe
  std::optional<Pose2> step_;  ///< to it from the one before, where that is known
  ConstantVelocityPrior expectation_;
  std::optional<ExpectedPose> expected_;
  double attached_ = 0.0;  ///< share of the recent scans that a keyframe stood for
};

}  // namespace shapemap
