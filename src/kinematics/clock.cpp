// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/clock.hpp"

#include <algorithm>

namespace krater {

namespace {

constexpr double kGrowth = 1.05;         // from one step to the next
constexpr double kFirstStepShare = 0.2;  // of the stable step of the start
constexpr double kMinStepShare = 1e-6;   // of the first step

}  // namespace

void StepClock::start(double rate) {
  free_dt_ = bounds_.first > 0 ? bounds_.first : kFirstStepShare * bounds_.cfl / rate;
  first_ = free_dt_;
  expected_dt_ = bounds_.cfl / rate;
  if (bounds_.most > 0) expected_dt_ = std::min(expected_dt_, bounds_.most);
  least_ = bounds_.least > 0 ? bounds_.least : kMinStepShare * free_dt_;
}

double StepClock::next(double rate, double until) {
  const double limit = stable_step(rate);
  double dt = limit;
  if (steps_ > 0)
    dt = std::min(dt, kGrowth * free_dt_);
  else
    dt = free_dt_;
  if (bounds_.most > 0) dt = std::min(dt, bounds_.most);
  // The first steps may be shorter than the least: they only grow towards the limit.
  if (!(limit >= least_) || !(dt >= std::min(least_, first_)))
    throw StepVanished{std::min(dt, limit), least_};
  free_dt_ = dt;
  const double left = until - time_;
  if (dt >= left) return left;
  return dt > 0.5 * left ? 0.5 * left : dt;
}

void StepClock::advance(double asked, double taken, double until) {
  dt_ = taken;
  if (taken < asked) free_dt_ = taken;
  ++steps_;
  const bool reached = taken == asked && asked == until - time_;
  time_ = reached ? until : time_ + taken;
}

void StepClock::restore(double time, double dt, double free_dt, std::int64_t steps) {
  time_ = time;
  dt_ = dt;
  free_dt_ = free_dt;
  steps_ = steps;
}

}  // namespace krater
