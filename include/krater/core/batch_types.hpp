// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file core/batch_types.hpp
/// Plain data of a batch, the same for every instruction-set level (views over it: batch.hpp).

namespace krater {

/// What went wrong first in a batch; the app turns it into a NumericalError that names body, point
/// and position.
enum class FaultKind : int {
  none = 0,
  not_finite_input,
  not_finite_velocity,
  inverted,
  not_finite_state,
  no_convergence,
  moved_too_far
};
struct Fault {
  FaultKind kind = FaultKind::none;
  int group = 0;       ///< lane group in the patch
  unsigned lanes = 0;  ///< offending lanes, bit i = lane i
};

/// Sums and events of one patch in one sweep; summed over patches in patch order.
struct Ledger {
  double plastic_work = 0;     ///< [J]
  double viscous_work = 0;     ///< [J]
  double plastic_heating = 0;  ///< [J] part of plastic work booked as temperature
  /// [J] stress power by the strain of the laws, of laws whose pressure does not need the energy.
  double barotropic_work = 0;
  double sound_speed_floors = 0, hugoniot_poles = 0, unconverged = 0;  ///< events counted
  double failures = 0, snap_backs = 0;  ///< points that failed; of these by snap-back
  double spalls = 0;                    ///< updates in which the tension was cut off
};

/// State and local records of consecutive lane groups, all in doubles.
struct BatchData {
  double* state;        ///< first group's state record
  int state_stride;     ///< doubles
  double* local;        ///< first group's local record
  int local_stride;     ///< doubles
  const double* zeros;  ///< at least 9 packs of zeros, 64-byte aligned
  int groups;           ///< number of lane groups
  int count;        ///< number of points; lanes past it in the last group are padding with mass 0
  int first_group;  ///< index of the first group in the patch, for faults
  double dt;        ///< [s]
  /// Width over which a point's motion is resolved [m], for viscosity and time step: 8 per group,
  /// `length_stride` apart; 0 where all points have the same, as on a grid.
  const double* length;
  int length_stride;
  Ledger* ledger;
  Fault* fault;
  /// Share of the step's work that the stages book in the energy: all of it where matter stands
  /// alone; none where a ledger has booked it (kinematics/mpm/ledger.hpp). The energy then is that
  /// of the middle of the step, half a step behind the pressure.
  double energy_share = 1;
  /// alpha of Algorithm 1 (materials/stages/eos_stage.hpp): share of the pressure of the start.
  double energy_alpha = 0.5;
};

}  // namespace krater
