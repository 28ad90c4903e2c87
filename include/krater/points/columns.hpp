// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file points/columns.hpp
/// Where a kinematics and contact find their own columns in the record of a lane group.

#include "krater/points/layout.hpp"

namespace krater {

/// Where the method finds its columns: offsets in the state record, -1 where a column does not
/// exist.
struct PointColumns {
  int stride = 0, local_stride = 0;
  int grid_position = -1;  ///< where the weights are taken: `position`, or on a fixed reference
  int reference = -1;      ///< position at the start
  int map = -1;            ///< fixed reference: F since then, over grid axes
  int position = -1, velocity = -1, mass = -1, density = -1;
  int affine = -1, stress = -1, pressure = -1, viscous = -1, energy = -1, sound_speed = -1;
  int carried = -1;  ///< energy owed by the point, part of the internal energy
  int removed = -1;  ///< `failed` where failure takes points out of the computation
  int failed = -1, indicator = -1, half_width = -1, body_acceleration = -1, grid_velocity = -1;
  int domain = -1, deformation = -1;
  int local_gradient = -1, local_dilatation = -1, local_signal = -1,
      local_rate = -1;        ///< local record
  int local_heat = -1;        ///< available heat, where energy is carried
  int local_correction = -1;  ///< of a fluid, whose pressure is integrated on the grid
};

}  // namespace krater
