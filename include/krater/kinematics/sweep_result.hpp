// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/sweep_result.hpp
/// What a sweep over some lane groups of elements or particles leaves behind, combined in their
/// order (kinematics/sweep_account.hpp).
#include "krater/core/batch_types.hpp"

namespace krater {

struct SweepResult {
  double internal = 0;             ///< [J]
  double max_rate = 0;             ///< 1/dt at CFL 1 [1/s]
  int limiter = 0, limiting = -1;  ///< 0 wave, 2 dilatation; index of the point
  Ledger ledger;
  Fault fault;
};

}  // namespace krater
