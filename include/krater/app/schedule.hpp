// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file app/schedule.hpp
/// Times of an output: k * interval, as one product, and the end, once. They depend on the time
/// reached only, so a restart goes on with the same ones. Rounding of k * interval is up to 1e-7 of
/// an interval at the most outputs that are counted (1e9), which the slack covers: without it an
/// end of 25 * interval came twice, 3e-21 s apart.
#include <cmath>

namespace krater {

class Schedule {
 public:
  /// `interval` [s]; 0: at the end only; too fine to be counted up to `end`: after every step.
  Schedule(double interval, double end, double now)
      : interval_{interval}, end_{end}, every_step_{interval > 0 && !(interval > kFinest * end)} {
    advance(now);
  }

  double next() const { return next_; }  ///< to stop at [s], never beyond the end
  bool due(double now) const { return every_step_ || now >= next_ - kSlack * interval_; }
  void advance(double now) {
    next_ = end_;
    if (interval_ <= 0 || every_step_) return;
    const double after = (std::floor(now / interval_ + kSlack) + 1) * interval_;
    if (after < end_ - kSlack * interval_) next_ = after;
  }

 private:
  static constexpr double kFinest = 1e-9;  ///< interval, of the end
  static constexpr double kSlack = 1e-6;   ///< of an interval
  double interval_, end_, next_ = 0;
  bool every_step_;
};

}  // namespace krater
