// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/sweep_account.hpp
/// What sweeps over elements or particles say to the rest of the step: the limit of the next one,
/// and the energies of the account.
#include "krater/kinematics/audit.hpp"
#include "krater/kinematics/kinematics.hpp"
#include "krater/kinematics/sweep_result.hpp"

namespace krater {

/// Where `result` limits the step more than `limit`: of a body in the scene, whose points have
/// their numbers in column `id`.
void note_limit(const SweepResult& result, int body, const PointStore& points, int id,
                TimeStepLimit& limit);

/// Books the sweeps of a step, one after the other.
class SweepAccount {
 public:
  SweepAccount(Audit& audit, const Standing& others);
  /// `internal`: all that is stored [J]; `more_work`: of laws that are no stages [J]; `barotropic`:
  /// the pressure does not know the energy.
  void add(const SweepResult& result, double internal, double more_work, bool barotropic);
  void close();

 private:
  Audit& audit_;
  double others_lead_, law_work_ = 0;
};

}  // namespace krater
