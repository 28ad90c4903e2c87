// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/clock.hpp
/// How long a step may be, whatever moves the bodies. With `rate` = 1/dt at CFL 1 of the present
/// state, the next step is
///   dt = min(cfl/rate, 1.05 dt_before, max_step),
/// the first one first_step, or 0.2 cfl/rate of the start: viscosity and the first shock are not
/// known yet. A step that would pass the next output time ends there, and one that would leave less
/// than itself goes half the way, so that no sliver of a step remains.
#include <cstdint>

namespace krater {

struct StepBounds {
  double cfl = 0.9;
  double first = 0;  ///< 0: automatic [s]
  double least = 0;  ///< 0: 1e-6 of the first [s]
  double most = 0;   ///< 0: none [s]
};

/// Thrown by StepClock::next(): the state allows less than the least step.
struct StepVanished {
  double step, least;  ///< [s]
};

class StepClock {
 public:
  explicit StepClock(const StepBounds& bounds) : bounds_{bounds} {}

  /// `rate`: of the greatest speeds of the start [1/s].
  void start(double rate);
  double stable_step(double rate) const { return bounds_.cfl / rate; }  ///< [s]
  /// The next step, not past `until` [s]. Throws StepVanished.
  double next(double rate, double until);
  /// The step that was asked for ended after `taken` [s]: less where the kinematics had to.
  void advance(double asked, double taken, double until);

  double time() const { return time_; }
  std::int64_t steps() const { return steps_; }
  double dt() const { return dt_; }                    ///< of the last step [s]
  double free_dt() const { return free_dt_; }          ///< the same before it was cut [s]
  double expected_dt() const { return expected_dt_; }  ///< towards which the first steps grow [s]
  double least() const { return least_; }              ///< [s]

  void restore(double time, double dt, double free_dt, std::int64_t steps);

 private:
  StepBounds bounds_;
  double time_ = 0, dt_ = 0, free_dt_ = 0, least_ = 0, first_ = 0, expected_dt_ = 0;
  std::int64_t steps_ = 0;
};

}  // namespace krater
