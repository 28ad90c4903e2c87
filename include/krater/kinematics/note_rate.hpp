// SPDX-License-Identifier: GPL-3.0-or-later
/// \file kinematics/note_rate.hpp
/// Which of a group's points, of `count` in all, limits the step.
#pragma once

#include "krater/core/simd.hpp"
#include "krater/kinematics/sweep_result.hpp"
#include "krater/points/layout.hpp"

namespace krater::inline KRATER_ISA {

KRATER_FORCE_INLINE void note_rate(int count, Pack rate, int kind, int g, SweepResult& out) {
  const Pack valid = select(first_lanes(count - kLanes * g), rate, Pack(0.0));
  if (!(hmax(valid) > out.max_rate)) return;
  for (int l = 0; l < kLanes; ++l)
    if (get(valid, l) > out.max_rate) {
      out.max_rate = get(valid, l);
      out.limiter = kind;
      out.limiting = kLanes * g + l;
    }
}

}  // namespace krater::inline KRATER_ISA
