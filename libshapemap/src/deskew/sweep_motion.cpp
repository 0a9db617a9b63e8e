// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "shapemap/core/errors.hpp"
#include "shapemap/core/parallel_for.hpp"

namespace shapemap {
namespace {

constexpr double kKnotsPerPeriod = 1.0;

/// The heading starts with these rates and accelerations.
constexpr double kMostRate_rad_s = 440 * kDegree;
constexpr double kRateStep_rad_s = 40 * kDegree;
constexpr double kMostAcceleration_rad_s2 = 2400 * kDegree;
constexpr double kAccelerationStep_rad_s2 = 1200 * kDegree;
/// So many rates are tried, and so many starts refined, for a long run; the quick numbers hold for short runs, of which
/// there are many.
constexpr std::size_t kStartRates = 23;
constexpr std::size_t kStarts = 12;
constexpr std::size_t kQuickRates = 5;
constexpr std::size_t kQuickStarts = 4;
constexpr std::size_t kFirstSweeps = 3;

/// The heading at the end of the next sweep may be this far from its prediction.
constexpr double kAsideStep_rad = 12 * kDegree;
constexpr int kAsideSteps = 4;

/// An extension that is worse than usual by this is searched further.
constexpr double kUsualFactor = 1.25;
constexpr double kUsualSlack_m = 0.004;
/// An extension that is worse than this may have lost the motion.
constexpr double kLost_m = 0.07;

/// This is more than any misfit.
constexpr double kImplausible_m = 1.0;

constexpr SweepFitOptions kTracking{0.5, 0.15, 5, 4e-3, 2, 1};
constexpr SweepFitOptions kRefinement{0.3, 0.12, 2, 2e-4, 2, 1};
constexpr SweepFitOptions kFinish{0.12, 0.08, 3, 2e-4, 1, 1};

class MotionSearch {
 public:
  MotionSearch(const std::vector<TimedSweep>& sweeps, double period_s)
      : sweeps_(sweeps),
        period_s_(period_s),
        trajectory_(first_s(sweeps), last_s(sweeps), period_s / kKnotsPerPeriod) {}

  /// Tries all rates on two sweeps first, then the likely ones with an acceleration on more of them.
  double start(std::size_t num, std::size_t num_rates, std::size_t num_starts) {
    std::vector<Start> starts;
    const std::size_t pair = std::min<std::size_t>(2, num);
    for_rates([&](double rate) { add_start(pair, rate, 0.0, starts); });
    keep_best(num_rates, starts);
    std::vector<Start> curved;
    for (const Start& one : starts) {
      for_accelerations([&](double more) { add_start(num, one.rate_rad_s, more, curved); });
    }
    keep_best(num_starts, curved);
    double best_m = std::numeric_limits<double>::infinity();
    std::vector<Eigen::Vector3d> best = trajectory_.controls();
    for (const Start& one : curved) {
      set_start(num, one.rate_rad_s, one.acceleration_rad_s2);
      fit_sweeps(sweeps_, {0, num, 0}, kTracking, trajectory_);
      const double misfit_m = misfit(0, num);
      if (misfit_m >= best_m) continue;
      best_m = misfit_m;
      best = trajectory_.controls();
    }
    trajectory_.controls() = best;
    usual_m_.push_back(best_m);
    return best_m;
  }

  void extend(std::size_t i) {
    const std::size_t known = end_of(i - 1);
    Extension next;
    next.sweep = i;
    next.first = i > 3 ? i - 3 : 0;
    next.free = i > 1 ? trajectory_.support(sweeps_[i - 2].first_s).first + 1 : 0;
    next.end = end_of(i);
    next.best = copied(next);
    const std::vector<Eigen::Vector3d> before = next.best;
    const double fine_m = kUsualFactor * usual_m() + kUsualSlack_m;
    for (int aside = 0; aside <= kAsideSteps && next.best_m > fine_m; ++aside) {
      for (const int sign : {1, -1}) {
        if (aside == 0 && sign < 0) continue;
        put(before, next);
        foresee(i, known, next.end, sign * aside * kAsideStep_rad);
        try_here(next);
      }
    }
    if (next.best_m > std::max(fine_m, kLost_m)) restart(before, next);
    put(next.best, next);
    usual_m_.push_back(next.best_m);
  }

  SweepTrajectory& trajectory() { return trajectory_; }

  double misfit(std::size_t first, std::size_t last) const {
    std::vector<PlacedSweep> placed;
    for (std::size_t i = first; i < last; ++i) {
      if (is_implausible(sweeps_[i], trajectory_)) return kImplausible_m;
      placed.push_back(placed_sweep(sweeps_[i], trajectory_));
    }
    double sum_m = 0.0;
    for (std::size_t i = 1; i < placed.size(); ++i) sum_m += sweep_misfit(placed[i - 1], placed[i]);
    return sum_m / std::max<double>(1.0, static_cast<double>(placed.size()) - 1.0);
  }

 private:
  /// The search for the next sweep moves the control points [free, end), and compares sweeps from `first` on.
  struct Extension {
    std::size_t sweep = 0;
    std::size_t first = 0;
    std::size_t free = 0;
    std::size_t end = 0;
    double best_m = std::numeric_limits<double>::infinity();
    std::vector<Eigen::Vector3d> best;
  };

  std::vector<Eigen::Vector3d> copied(const Extension& next) const {
    const auto begin = trajectory_.controls().begin();
    return {begin + static_cast<std::ptrdiff_t>(next.free), begin + static_cast<std::ptrdiff_t>(next.end)};
  }

  void put(const std::vector<Eigen::Vector3d>& controls, const Extension& next) {
    std::copy(controls.begin(), controls.end(),
              trajectory_.controls().begin() + static_cast<std::ptrdiff_t>(next.free));
  }

  void try_here(Extension& next) {
    const std::size_t i = next.sweep;
    fit_sweeps(sweeps_, {next.first, i + 1, next.free}, kTracking, trajectory_);
    const double misfit_m = misfit(i > 1 ? i - 2 : 0, i + 1);
    if (!(misfit_m < next.best_m)) return;
    next.best_m = misfit_m;
    next.best = copied(next);
  }

  /// Starts anew from the last sweep, with all rates.
  void restart(const std::vector<Eigen::Vector3d>& before, Extension& next) {
    const std::size_t last = next.sweep - 1;
    put(next.best, next);
    const double from_s = sweeps_[last].first_s;
    const Eigen::Vector3d from = trajectory_.at(from_s);
    const auto set = [&](double rate_rad_s, double acceleration_rad_s2) {
      put(before, next);
      for (std::size_t k = next.free; k < next.end; ++k) {
        const double t = trajectory_.time_of(k) - from_s;
        if (t <= -period_s_) continue;
        trajectory_.controls()[k] = from;
        trajectory_.controls()[k].z() += rate_rad_s * t + 0.5 * acceleration_rad_s2 * t * t;
      }
    };
    std::vector<Start> starts;
    for_rates([&](double rate) {
      for_accelerations([&](double more) {
        set(rate, more);
        starts.push_back({misfit(last, next.sweep + 1), rate, more});
      });
    });
    keep_best(kQuickStarts, starts);
    for (const Start& one : starts) {
      set(one.rate_rad_s, one.acceleration_rad_s2);
      try_here(next);
    }
  }

  template <class Visit>
  static void for_rates(const Visit& visit) {
    const auto steps = static_cast<int>(std::lround(kMostRate_rad_s / kRateStep_rad_s));
    for (int k = -steps; k <= steps; ++k) visit(k * kRateStep_rad_s);
  }

  template <class Visit>
  static void for_accelerations(const Visit& visit) {
    const auto steps = static_cast<int>(std::lround(kMostAcceleration_rad_s2 / kAccelerationStep_rad_s2));
    for (int k = -steps; k <= steps; ++k) visit(k * kAccelerationStep_rad_s2);
  }

  struct Start {
    double misfit_m;
    double rate_rad_s;
    double acceleration_rad_s2;
  };

  void add_start(std::size_t num, double rate_rad_s, double acceleration_rad_s2, std::vector<Start>& starts) {
    set_start(num, rate_rad_s, acceleration_rad_s2);
    starts.push_back({misfit(0, num), rate_rad_s, acceleration_rad_s2});
  }

  static void keep_best(std::size_t num, std::vector<Start>& starts) {
    std::stable_sort(starts.begin(), starts.end(),
                     [](const Start& a, const Start& b) { return a.misfit_m < b.misfit_m; });
    starts.resize(std::min(starts.size(), num));
  }

  static double first_s(const std::vector<TimedSweep>& sweeps) {
    double first_s = sweeps.front().first_s;
    for (const TimedSweep& sweep : sweeps) first_s = std::min({first_s, sweep.first_s, sweep.stamp_s});
    return first_s;
  }

  static double last_s(const std::vector<TimedSweep>& sweeps) {
    double last_s = sweeps.front().last_s;
    for (const TimedSweep& sweep : sweeps) last_s = std::max({last_s, sweep.last_s, sweep.stamp_s});
    return last_s;
  }

  std::size_t end_of(std::size_t sweep) const {
    return trajectory_.support(sweeps_[sweep].last_s).first + SweepTrajectory::kOrder;
  }

  void set_start(std::size_t num, double rate_rad_s, double acceleration_rad_s2) {
    const double start_s = sweeps_.front().first_s;
    for (std::size_t k = 0; k < end_of(num - 1); ++k) {
      const double t = trajectory_.time_of(k) - start_s;
      trajectory_.controls()[k] = {0.0, 0.0, rate_rad_s * t + 0.5 * acceleration_rad_s2 * t * t};
    }
  }

  /// Extrapolates the control points that are not known yet.
  void foresee(std::size_t i, std::size_t known, std::size_t end, double aside_rad) {
    std::vector<Eigen::Vector3d>& c = trajectory_.controls();
    for (std::size_t k = known; k < end; ++k) {
      c[k] = 2.0 * c[k - 1] - c[k - 2] + 0.5 * (c[k - 1] - 2.0 * c[k - 2] + c[k - 3]);
    }
    for (std::size_t k = 0; k < end; ++k) {
      const double after_s = trajectory_.time_of(k) - sweeps_[i].first_s;
      if (after_s > 0.0) c[k].z() += aside_rad * after_s / period_s_;
    }
  }

  double usual_m() const {
    constexpr std::size_t kRecent = 21;
    const std::size_t num = std::min(kRecent, usual_m_.size());
    std::vector<double> recent(usual_m_.end() - static_cast<std::ptrdiff_t>(num), usual_m_.end());
    std::nth_element(recent.begin(), recent.begin() + static_cast<std::ptrdiff_t>(num / 2), recent.end());
    return recent[num / 2];
  }

  const std::vector<TimedSweep>& sweeps_;
  double period_s_;
  SweepTrajectory trajectory_;
  std::vector<double> usual_m_;
};

}  // namespace

SweepMotion sweep_motion(const std::vector<TimedSweep>& sweeps, double period_s, int threads,
                         const std::function<bool(std::size_t done)>& keep_going) {
  const auto check = [&](std::size_t done) {
    if (keep_going && !keep_going(done)) throw Interrupted();
  };
  MotionSearch search(sweeps, period_s);
  search.start(std::min(kFirstSweeps, sweeps.size()), kStartRates, kStarts);
  for (std::size_t i = std::min(kFirstSweeps, sweeps.size()); i < sweeps.size(); ++i) {
    check(i);
    search.extend(i);
  }
  check(sweeps.size());
  const auto fit = [&](SweepFitOptions options, SweepTrajectory& trajectory) {
    options.threads = threads;
    fit_sweeps(sweeps, {0, sweeps.size(), 0}, options, trajectory);
  };
  fit(kRefinement, search.trajectory());
  SweepTrajectory trajectory = search.trajectory().refined();
  fit(kFinish, trajectory);
  SweepMotion motion{trajectory, std::vector<double>(sweeps.size(), 0.0)};
  parallel_for(sweeps.size(), threads, [&](std::size_t i) {
    if (i == 0) return;
    if (is_implausible(sweeps[i - 1], motion.trajectory) || is_implausible(sweeps[i], motion.trajectory)) {
      motion.misfit_m[i] = kImplausible_m;
      return;
    }
    motion.misfit_m[i] =
        sweep_misfit(placed_sweep(sweeps[i - 1], motion.trajectory), placed_sweep(sweeps[i], motion.trajectory));
  });
  return motion;
}

ShortMotion short_motion(const std::vector<TimedSweep>& sweeps, double period_s) {
  MotionSearch search(sweeps, period_s);
  const double misfit_m = search.start(sweeps.size(), kQuickRates, kQuickStarts);
  return {search.trajectory(), misfit_m};
}

}  // namespace shapemap
