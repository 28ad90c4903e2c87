// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file simulation/stage_timer.hpp
/// What the stages of a body cost: they are applied to copies of points of the run, and timed
/// there. The run itself is not measured point by point, for a clock in its loop would cost what it
/// tells. Another body, of the same scene without an effect, takes the same points; the difference
/// of the two is what the effect costs in the stages. Moving its columns between memory and
/// processor is not in it.
#include <memory>
#include <optional>

#include "krater/simulation/simulation.hpp"

namespace krater {

/// Some points of a body with the motion of the step that they took last.
struct PointSample {
  const Layout* layout = nullptr;  ///< of `state`
  AlignedBuffer state;             ///< lane groups
  AlignedBuffer gradient;          ///< dt L, nine components of a lane group after another
  int count = 0;
  double dt = 0, length = 0;
  int groups() const { return (count + kLanes - 1) / kLanes; }
};

/// One batch of a body, another one for each `turn`; nothing where it has no points, or points that
/// carry no velocity gradient (elements, transfers flip and xpic).
std::optional<PointSample> sample_points(const Simulation& sim, int body, std::int64_t turn);

class StageTimer {
 public:
  StageTimer(std::shared_ptr<const Scene> scene, int body, IsaLevel level);

  int bytes_per_point() const { return body_.layout().stride(); }
  void measure(const PointSample& sample);
  /// Mean over what was measured, per point and step; NaN of nothing.
  double nanoseconds() const;

 private:
  void load(const PointSample& sample);
  double apply(const PointSample& sample);  ///< [s]

  std::shared_ptr<const Scene> scene_;
  Body body_;
  int gradient_ = -1;  ///< in the local record
  AlignedBuffer state_, local_, zeros_;
  Ledger ledger_;
  Fault fault_;
  double seconds_ = 0, points_ = 0;
};

}  // namespace krater
