// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/energy_watch.hpp
/// No run makes energy. With E = kinetic + internal + removed and what came in,
///   E_in = E_0 + W_external (+ W_wall where a side of the domain is driven),
/// a step ends the run when E - E_in > kMostGain times the greatest E so far: half as much again
/// has come from nowhere. Losses are reported, not judged, but internal energy that is as far below
/// zero was never there to give. Contact and resting walls can only take
/// energy, so what they give counts as a gain. The kinetic energy of the nodes, which holds for
/// every point, is judged before a point is touched: whatever throws nodes about (contact, walls,
/// forces of a broken state) ends the run while its points are still those of the last good step.
/// A ledger entry that is not finite ends it at once. The cost is a handful of additions a step.
///
/// What is not physical (Audit::unphysical) may reach the share `allowed` of the energy in the
/// scene. A body that a driven side sets in motion loses half of its first energy in one layer of
/// cells, a share that falls with the work that follows. So it is judged when the energy has come,
/// at the end and when its mean over time,
///   int E_peak dt/t >= kSettled E_peak:
/// at once in an impact, 3 t_1 after a jump at t_1, at the end under a steady load.
#include "krater/contact/boundary.hpp"
#include "krater/core/errors.hpp"
#include "krater/kinematics/audit.hpp"

namespace krater {

/// Energy came from nowhere, or a ledger entry is not a number.
struct EnergyError : NumericalError {
  using NumericalError::NumericalError;
};

class EnergyWatch {
 public:
  static constexpr double kMostGain = 0.5, kSettled = 0.75;

  /// Where a side of the domain is driven the work of walls is work from outside.
  explicit EnergyWatch(const BoundarySet& boundary) : boundary_{boundary} {}

  /// Before points are touched: `kinetic` of the nodes as points will see them, `work` of external
  /// forces and driven bodies and of walls in this step [J]. Throws EnergyError.
  struct StepWork {
    double external, walls;
  };
  void check_nodes(const Audit& audit, double kinetic, const StepWork& work) const;
  /// After a step of length dt that is booked. Throws EnergyError.
  void check(Audit& audit, double dt) const;
  /// After that. `allowed`: 0 for any. Throws EnergyError.
  static void check_error(const Audit& audit, double allowed, double time, bool last);

 private:
  double came_in(const Audit& audit) const;

  const BoundarySet& boundary_;
};

}  // namespace krater
