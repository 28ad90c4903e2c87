// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/gather_views.hpp
/// What the gather reads and writes: the columns of a patch.
#include "krater/kinematics/mpm/scatter.hpp"

namespace krater::inline KRATER_ISA {

/// The columns the gather touches, as views.
struct GatherViews {
  WriteView position, velocity, affine, kept, map, half_width, domain;
  ReadView grid_position, mass, density, body_acceleration, sound_speed, failed;
  ReadView old_affine, stress, pressure, viscous, carried;
  WriteView energy, indicator;
  WriteView step_gradient, extra_dilatation;
  ReadView signal;
};

KRATER_FORCE_INLINE GatherViews make_views(Patch& patch, const PointColumns& c,
                                           const SweepScratch& w) {
  const auto read = [&](int offset) { return state_view(patch, offset, c.stride, w.zeros); };
  const auto write = [&](int offset) { return WriteView{patch.points.data() + offset, c.stride}; };
  return {write(c.position),
          write(c.velocity),
          write(c.affine),
          write(c.grid_velocity),
          write(c.map),
          write(c.half_width),
          write(c.domain),
          read(c.grid_position),
          read(c.mass),
          read(c.density),
          read(c.body_acceleration),
          read(c.sound_speed),
          read(c.failed),
          read(c.affine),
          read(c.stress),
          read(c.pressure),
          read(c.viscous),
          read(c.carried),
          write(c.energy),
          write(c.indicator),
          WriteView{w.local + c.local_gradient, c.local_stride},
          WriteView{w.local + c.local_dilatation, c.local_stride},
          ReadView{w.local + c.local_signal, c.local_stride}};
}

KRATER_FORCE_INLINE ReadView reading(WriteView v) { return {v.base, v.stride}; }

}  // namespace krater::inline KRATER_ISA
