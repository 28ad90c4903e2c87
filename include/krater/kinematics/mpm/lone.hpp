// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/lone.hpp
/// Points that see little mass but their own (theory 20): m_p sum S^2 > a sum S m_i. With a = 0.9 a
/// point carries no L to the grid and does not strain with it: alone its own pressure would expand
/// it for ever. A failed one, which no tension holds, needs more company to carry L: two on their
/// own would still expand (a = 0.4).
///
/// Threads. A point among few others strains in all directions against nodes that are its own:
/// omega^2 <= sum_a g_a c^2, g_a = sum (S')^2/S <= 6/h^2, whatever its neighbours do (the highest
/// frequency of a sum of parts is at most that of the stiffest part with its share of the masses).
/// So dt <= h/(c sqrt(1.5 dim)) is stable anywhere, which only threads need: a free block takes
/// (12.1), and threads in the plane take it too (tools/stability.py).
#include "krater/kinematics/mpm/gather_views.hpp"

namespace krater::inline KRATER_ISA {

/// Shares of the mass it sees from which a point does not strain, and from which it carries no L.
inline constexpr double kAlone = 0.9, kCrowd = 0.4;
/// The same, from which a point is of a thread: corners of blocks, bars and sheets stay below.
inline constexpr double kThread = 0.25;

struct Alone {
  Mask lone, silent, thread;
};
template <int Dim>
KRATER_FORCE_INLINE Alone alone_points(const GatherViews& view, const PointSums<Dim>& n,
                                       const LaneWeights<Dim>& lw, int g) {
  Pack own = view.mass(g);  // m_p sum S^2: the point's share of the mass it sees
  for (int a = 0; a < Dim; ++a) {
    Pack squares = 0.0;
    for (int i = 0; i < Support::support; ++i)
      squares = fma(load(lw.w[a][i]), load(lw.w[a][i]), squares);
    own = own * squares;
  }
  const Pack crowd = select(view.failed(g) > Pack(0.5), Pack(kCrowd), Pack(kAlone));
  const Mask lone = own > kAlone * n.V[3];
  return {lone, own > crowd * n.V[3], (own > kThread * n.V[3]) & !lone};
}

/// The rate h/dt of a thread's points that bear something [1/s].
template <int Dim>
KRATER_FORCE_INLINE Pack thread_rate(const GatherViews& view, Mask thread, double inv_h, int g) {
  const Mask open = (view.failed(g) > Pack(0.5)) & !(view.pressure(g) > Pack(0.0));
  return select(thread & !open, view.sound_speed(g) * (std::sqrt(1.5 * Dim) * inv_h), Pack(0.0));
}

/// How a lone point follows its tension: L of it, in place of that of the grid, which moves as the
/// point does. All its surface is free, so that no mean stress stays in it (int sigma dV = 0 for a
/// body without tractions):
///   tr L = -u/h,   u = |p|/(rho c), and sqrt(|p|/rho) at most, for c may be but a floor.
/// A sound ring that would come into tension gives its section what it stretches, L_rr = L_zz =
/// -L_tt/2: with sections that stayed as they were, rings of a jet held 30 GPa when their radius
/// had grown by half. `hoop` [1/s].
template <class Frame>
KRATER_FORCE_INLINE void close_lone(const GatherViews& view, Mask lone, Pack hoop,
                                    const SweepSettings& s, int g,
                                    Pack (&L)[Frame::dim][Frame::dim]) {
  constexpr int D = Frame::dim;
  const Pack p = view.pressure(g), rho = view.density(g), c = view.sound_speed(g),
             opens = max(Pack(0.0), hoop), square = max(Pack(0.0), -p) / rho;
  const Pack u =
      select(square > Pack(0.0), square / max(sqrt(square), c), Pack(0.0)) * s.geometry->inv_h;
  const Mask closes =
      lone & (view.failed(g) < Pack(0.5)) & (p < Pack(s.dt) * opens * (rho * c * c));
  for (int i = 0; i < D; ++i)
    for (int a = 0; a < D; ++a) {
      const Pack own = i == a ? -(1.0 / D) * (u + opens) : Pack(0.0);
      L[i][a] = select(lone, select(closes, own, Pack(0.0)), L[i][a]);
    }
}

}  // namespace krater::inline KRATER_ISA
