// SPDX-License-Identifier: GPL-3.0-or-later
/// \file kinematics/sph/sph_limits.hpp
/// What the state of particles allows: of a step (note_limits), and of a reference (note_stretch).
#pragma once

#include <algorithm>

#include "krater/core/lane_math.hpp"
#include "krater/core/stability.hpp"
#include "krater/kinematics/note_rate.hpp"
#include "krater/kinematics/sph/sph_lanes.hpp"

namespace krater::inline KRATER_ISA {

/// Length of a particle, V^(1/d), but no more than h: a damping across a greater one would be more
/// than critical.
template <int Dim>
KRATER_FORCE_INLINE Pack particle_length(const SphData& d, Pack volume) {
  const Pack some = max(volume, Pack(1e-200));  // empty lanes have none
  const Pack root = rcbrt(some), whole = Dim == 3 ? some * root * root : sqrt(some);
  return min(Pack(d.h), whole);
}

/// The step of the stiffest motion, of frequency 2 c_L/l, damped by Q/c_L:
///   dt = l/(Q + sqrt(Q^2 + c_L^2)),  Q = L/l (q_lin c + 2 q_quad L |tr D|),
///   l = h c_L/sqrt(c_L^2 + c^2).
/// That motion is one of free corners, where corrected gradients are long: of blocks its period
/// allows 1.02 to 1.5 times l/c_L (both weights, h/dx 1.2 to 1.8, Poisson's ratio 0 to 0.49, shaken
/// by a quarter of dx, flattened to a third), of eight particles alone 0.68; without faces 1.9. The
/// viscosity of pairs damps an alternating motion by 2 z c/d sum_j V_j |W'|, at most 2.33 z c/h
/// (Wendland in the plane) and near corners by a fifth more, which adds 0.7 z c l/h to Q.
template <int Dim>
KRATER_FORCE_INLINE void note_limits(const SphData& d, const SphViews& view, int g,
                                     SphResult& out) {
  const Pack c = view.sound_speed(g), rho = view.density(g),
             G = load(d.remembered + 2 * kLanes * g),
             tr_D = load(d.remembered + (2 * g + 1) * kLanes);
  const Pack c_L_squared = fma(c, c, (4.0 / 3.0) * G / rho);
  const Pack per_length = (1 / d.h) * sqrt(1.0 + c * c / c_L_squared);
  const Pack closing = max(Pack(0.0), -tr_D), length = particle_length<Dim>(d, view.mass(g) / rho);
  const Pack viscous = per_length * length * fma((2.0 * d.q_quad) * length, closing, d.q_lin * c);
  const Pack Qv = (0.7 * d.zero_energy / d.h) * c / per_length +
                  select(closing > Pack(0.0), viscous, Pack(0.0));
  note_rate(d.count, per_length * (Qv + sqrt(fma(Qv, Qv, c_L_squared))), 0, g, out);
  note_rate(d.count, abs(tr_D) * (1 / kMostDilatation), 2, g, out);
}

KRATER_FORCE_INLINE void note_stretch(const Mat3<Pack>& F, Mask valid, SphResult& out) {
  const Mat3<Pack> C = transpose(F) * F;
  Pack most = max(max(abs(C.xx - 1.0), abs(C.yy - 1.0)), abs(C.zz - 1.0));
  most = max(most, max(max(abs(C.xy), abs(C.xz)), abs(C.yz)));
  out.stretch = std::max(out.stretch, hmax(select(valid, most, Pack(0.0))));
}

}  // namespace krater::inline KRATER_ISA
