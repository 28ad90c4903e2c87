// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "krater/core/errors.hpp"
#include "krater/point_driver/loading_path.hpp"
#include "krater/simulation/simulation.hpp"

namespace krater {

namespace {

using Eigen::Matrix3d;

constexpr int kMostTrials = 200;
// Of the stress in force, and of the modulus: what round-off of the pressure leaves.
constexpr double kTolerance = 1e-10, kRoundOff = 1e-14;
constexpr double kLargestStretch = 0.5;  // log strain of one step
// A stress that falls so many times faster than it would unload has jumped: softening that is
// resolved by the steps grows towards this, one that snaps back passes it within a step.
constexpr double kJump = 10;

Matrix3d with_stretch(const PathStep& step, double x) {
  Matrix3d map = step.map;
  if (step.control == Control::none) return map;
  const double stretch = std::expm1(x);
  const int first = step.control == Control::mean_stress     ? 0
                    : step.control == Control::normal_stress ? 2
                                                             : 1;
  for (int k = first; k < 3; ++k) map(k, k) = stretch;
  return map;
}

/// Keeps the ends of the bracket and proposes the next trial.
class Bracket {
 public:
  void add(double x, double r) {
    before_ = last_;
    last_ = {x, r};
    if (std::isnan(r)) return;
    End& end = r < 0 ? negative_ : positive_;
    // Illinois: an end that stays twice loses half its weight.
    End& other = r < 0 ? positive_ : negative_;
    if (end_stayed_ == &other && !std::isnan(other.r)) other.r *= 0.5;
    end_stayed_ = &other;
    end = {x, r};
    (r < 0 ? below_ : above_) = r;
  }
  /// Why there is no root: the sides of a jump, or how near one came.
  std::string said(double target) const {
    if (std::isnan(below_) && std::isnan(above_)) return "the law failed in all of them";
    if (std::isnan(below_) || std::isnan(above_))
      return fmt::format("the nearest is {:.6g} Pa",
                         target + (std::isnan(below_) ? above_ : below_));
    return fmt::format("it jumps from {:.8g} to {:.8g} Pa within a stretch of {:.1g}",
                       target + below_, target + above_, std::fabs(positive_.x - negative_.x));
  }
  double next(double first, int trial) const {
    const bool bracketed = !std::isnan(negative_.x) && !std::isnan(positive_.x);
    if (bracketed && trial % 8 == 7) return 0.5 * (negative_.x + positive_.x);
    if (bracketed)
      return negative_.x - negative_.r * (positive_.x - negative_.x) / (positive_.r - negative_.r);
    const double secant = last_.x - last_.r * (last_.x - before_.x) / (last_.r - before_.r);
    if (trial < 8 && std::isfinite(secant) && std::fabs(secant) < kLargestStretch) return secant;
    // Nothing on the other side yet: wider and wider on both sides of the first trial.
    const double reach = 1e-8 * std::pow(2.0, trial / 2);
    return std::clamp(first + (trial % 2 == 0 ? reach : -reach), -kLargestStretch, kLargestStretch);
  }

 private:
  struct End {
    double x = std::numeric_limits<double>::quiet_NaN(), r = x;
  };
  End negative_, positive_, last_, before_;
  double below_ = std::numeric_limits<double>::quiet_NaN(), above_ = below_;  ///< unweighted
  const End* end_stayed_ = nullptr;
};

const char* text_of(Control control) {
  switch (control) {
    case Control::lateral_stress:
      return "no lateral stretch gives the lateral stress";
    case Control::normal_stress:
      return "no stretch along z gives the stress along z";
    case Control::triaxiality:
      return "no lateral stretch gives the triaxiality";
    default:
      return "no change of volume gives the mean stress";
  }
}

}  // namespace

double PathDriver::stiffness() const {
  const double c = point_.value(field::SoundSpeed::info);
  return point_.value(field::Density::info) * c * c;
}

double PathDriver::residual(const PathStep& step, double x) {
  using Clock = std::chrono::steady_clock;
  if (trials_ > 0) point_.restore(saved_);
  ++trials_;
  ++updates_;
  const Matrix3d map = with_stretch(step, x);
  const auto begin = Clock::now();
  point_.step(map, step.dt);
  seconds_ += std::chrono::duration<double>(Clock::now() - begin).count();
  if (point_.fault() != FaultKind::none) return std::numeric_limits<double>::quiet_NaN();
  const Matrix3d sigma = point_.stress();
  const double mean = sigma.trace() / 3;
  switch (step.control) {
    case Control::lateral_stress:
      return sigma(1, 1) - step.target;
    case Control::normal_stress:
      return sigma(2, 2) - step.target;
    case Control::triaxiality:
      return mean - 1.5 * step.target * (sigma(0, 0) - mean);
    case Control::mean_stress:
      return mean - step.target;
    case Control::none:
      break;
  }
  return 0;
}

bool PathDriver::good(double residual, const PathStep& step) const {
  const double scale = std::max(point_.stress().norm(), std::fabs(step.target));
  return std::fabs(residual) <= kTolerance * scale + kRoundOff * stiffness();
}

Matrix3d PathDriver::solve(const PathStep& step) {
  const double before = guess_, modulus = 3 * stiffness();
  Bracket bracket;
  double x = guess_;
  for (int i = 0; i < kMostTrials; ++i) {
    const double r = residual(step, x);
    if (good(r, step)) {
      guess_ = x;
      return with_stretch(step, x);
    }
    bracket.add(x, r);
    x = i == 0 ? x - (std::isnan(r) ? x : r / modulus) : bracket.next(before, i);
  }
  const FaultKind kind = point_.fault();
  if (step.control == Control::mean_stress && step.target > 0)
    throw InputError(fmt::format(
        "point.path: the material does not bear a mean tension of {:.4g} Pa; stresses are positive "
        "in tension: write a confinement as a negative lateral_stress, a hydrostat by its pressure",
        step.target));
  const std::string why = kind != FaultKind::none                ? text_of(kind)
                          : step.control == Control::triaxiality ? "the residual stays"
                                                                 : bracket.said(step.target);
  throw NumericalError(fmt::format("{} ({} trials; {}); use more steps or another target",
                                   text_of(step.control), kMostTrials, why));
}

void PathDriver::note_jump(const PathStep& step, double before) {
  const double after = point_.stress()(0, 0), strain = std::log1p(step.map(0, 0));
  const double fall = std::fabs(before) - std::fabs(after);
  if (!(before * strain > 0) || fall <= kJump * stiffness() * std::fabs(strain)) return;
  if (jumps_++ == 0) first_jump_ = {before, after, strain};
}

Matrix3d PathDriver::take(const PathStep& step) {
  trials_ = 0;
  if (step.control != Control::none) {
    saved_ = point_.save();
    const double before = point_.stress()(0, 0);
    const Matrix3d map = solve(step);
    if (step.control != Control::mean_stress) note_jump(step, before);
    return map;
  }
  residual(step, 0);
  if (point_.fault() != FaultKind::none)
    throw NumericalError(fmt::format("{}; use more steps", text_of(point_.fault())));
  return step.map;
}

}  // namespace krater
