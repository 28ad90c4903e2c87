// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/ledger.hpp
/// The energy ledger: what a step takes from the motion of the points of a cell, and does not give
/// back as stress power, becomes heat of these points. At the nodes, with the final v+ = v- + dv
/// (forces, contact, walls) and vbar = v- + dv/2,
///   k_i = vbar_i . dv_i + eta_i       eta: heat of contact and walls (contact/impulse_heat.hpp),
/// and at the points, with s = sum S v, L = sum v (x) grad S, Ds = sum S dv, r = v_p - s- and
/// D = h^2/4,
///   W  = dt V sigma : (L+ + L-)/2        work of the very stress that was scattered,
///   v1 = v_p + Ds,  n = sum S k - Ds.(v_p + Ds/2) + D/2 (|L_p|^2 - |L'_p|^2),
/// and over the points of a body with a common base node, gamma = 1 - alpha,
///   r* = r - <r>,  v' = v1 - gamma r*,
///   E_c = sum m [n + gamma r*.(v1 - <v1>) - gamma^2/2 |r*|^2],   de = W/m + E_c/M_c.
/// As sum_i f_i . vbar_i dt = - sum_p W (the same V, sigma and grad S) and sum_p m_p S_ip = m_i,
///   d(kinetic + internal) = work from outside,
/// to round-off, for any motion. The filter takes no momentum from a cell, so E_c is the same for
/// every observer; a cell that a folding side cuts is one with its image, where <r> and <v1> of odd
/// components are zero, and the side takes the momentum.
/// What is dropped from a stress (failure, spall, damage) is not returned as work
/// and stays in e. Energies are differences of large squares: n is formed from Ds, not from
/// |v'|^2 - |v|^2, and velocities are taken from that of the patch's first point.
/// With cell averages (1 - b) p + b P_c is scattered; W then has the trace (1 - b) tr + b tr_c,
/// which is the adjoint, so that sums agree and a point's energy follows its own volume.
/// E_c < 0 is taken from the heat a of the points (materials/stages/heat_floor_stage.hpp), in
/// proportion to it and no more than there is; the rest is carried by the points of the cell as a
/// debt, which counts in the internal energy, and paid from what they are given next.
/// e is that of t_{n+1/2}, where the velocities are; the stages find the pressure half a step
/// ahead. Sources: Burgess, Sulsky, Brackbill 1992 (JCP 103, 1) for the loss of the round trip;
/// Caramana, Burton, Shashkov, Whalen 1998 (JCP 146, 227) for the work of the very forces; DeBar
/// 1974.
#include "krater/kinematics/frames.hpp"
#include "krater/kinematics/mpm/cells.hpp"
#include "krater/kinematics/mpm/configuration.hpp"

namespace krater::inline KRATER_ISA {

/// Where the records of the cells begin in SweepScratch::cells.
inline constexpr int kCellLedger = 3 * kBlockNodes;

/// Sums of each cell of a block over 8 slots [M, sum m r, sum m (v1 - v_0), Q], then
/// [.., <r>, .., E_c/M_c]; Q = sum m (n + gamma r.(v1 - v_0) - gamma^2/2 |r|^2). Where matter knows
/// its energy two more, in place of the velocities: heat taken over what there is, energy carried.
template <int Dim>
struct CellLedger {
  static constexpr int mass = 0, residual = 1, velocity = 1 + Dim, taken = velocity,
                       carried = velocity + 1, heat = 7;
  double* records;  ///< 8 per cell

  KRATER_FORCE_INLINE void clear() const {
    for (int c = 0; c < kBlockNodes; ++c) store(records + 8 * c, Pack(0.0));
  }
  /// `slots`: one pack per slot, a lane per point; `cells`: their cells.
  KRATER_FORCE_INLINE void add(const double* cells, Pack (&slots)[8]) const {
    transpose8(slots);
    for (int l = 0; l < kLanes; ++l) {
      double* record = records + 8 * static_cast<int>(cells[l]);
      store(record, load(record) + slots[l]);
    }
  }
  KRATER_FORCE_INLINE void look_up(const double* cells, Pack (&slots)[8]) const {
    for (int l = 0; l < kLanes; ++l) slots[l] = load(records + 8 * static_cast<int>(cells[l]));
    transpose8(slots);
  }
  /// Means and heat per mass of all cells, eight at a time. `base`: v_0.
  void close(const SweepSettings& s, const PatchOrigin& origin, const double* base,
             PatchResult& result) const {
    const bool cut = s.gamma > 0 && holds_cut_cells(s, origin);
    Pack given = 0.0, taken_back = 0.0;
    result.cut_impulse = {};
    for (int first = 0; first < kBlockNodes; first += kLanes) {
      Pack c[8];
      for (int k = 0; k < kLanes; ++k) c[k] = load(records + 8 * (first + k));
      transpose8(c);
      const Pack M = c[mass], inverse = select(M > Pack(0.0), 1.0 / M, Pack(0.0));
      const Pack odd = cut ? odd_components(s, origin, first) : Pack(0.0);
      Pack across = 0.0;
      for (int a = 0; a < Dim; ++a) {
        const Mask flips = has_bit(odd, a);
        const Pack R = select(flips, Pack(0.0), c[residual + a] * inverse),
                   lost = select(flips, c[residual + a], Pack(0.0));
        across = fma(R, fnma(0.5 * s.gamma * M, R, c[velocity + a]), fnma(lost, base[a], across));
        if (cut) result.cut_impulse[static_cast<unsigned>(a)] -= s.gamma * sum(lost);
        c[residual + a] = R;
      }
      const Pack E = fnma(Pack(s.gamma), across, c[heat]);
      given += max(E, Pack(0.0));
      taken_back += min(E, Pack(0.0));
      c[heat] = E * inverse;
      c[taken] = c[carried] = 0.0;
      transpose8(c);
      for (int k = 0; k < kLanes; ++k) store(records + 8 * (first + k), c[k]);
    }
    result.heat_given = sum(given);
    result.heat_taken = sum(taken_back);
  }

 private:
  static bool holds_cut_cells(const SweepSettings& s, const PatchOrigin& origin) {
    for (int a = 0; a < Dim; ++a)
      for (const CutCells& side : s.cut[static_cast<unsigned>(a)]) {
        const int at = side.cell - static_cast<int>(origin.first[a]);
        if (side.odd != 0 && at >= 0 && at < block_edge(Dim)) return true;
      }
    return false;
  }
  /// Bit per component of the velocity whose mean with its image beyond a side is zero, of the
  /// cells from `first` on.
  static Pack odd_components(const SweepSettings& s, const PatchOrigin& origin, int first) {
    alignas(64) double out[kLanes];
    for (int k = 0; k < kLanes; ++k) {
      unsigned odd = 0;
      for (int a = Dim - 1, rest = first + k; a >= 0; --a, rest /= block_edge(Dim)) {
        const int cell = static_cast<int>(origin.first[a]) + rest % block_edge(Dim);
        for (const CutCells& side : s.cut[static_cast<unsigned>(a)])
          if (side.cell == cell) odd |= side.odd;
      }
      out[k] = odd;
    }
    return load(out);
  }
  static Mask has_bit(Pack bits, int bit) {
    const double weight = 1U << static_cast<unsigned>(bit);
    return floor(bits * (0.5 / weight)) * 2.0 < floor(bits * (1 / weight));
  }
};

/// Sums over cells from a loop over points, one slot of the records.
KRATER_FORCE_INLINE void add_slot(double* records, int slot, const double* cells, Pack quantity) {
  alignas(64) double q[8];
  store(q, quantity);
  for (int l = 0; l < kLanes; ++l) records[8 * static_cast<int>(cells[l]) + slot] += q[l];
}

/// L+ - DL/2 of 8 points over tensor axes, and its trace; on a fixed reference `inverse` is F^-1.
template <class Frame>
struct MeanGradient {
  Pack of[Frame::dim][Frame::dim], hoop = 0.0, trace = 0.0;
};
template <class Frame, class Configuration>
KRATER_FORCE_INLINE MeanGradient<Frame> mean_gradient(const Pack (&V)[8],
                                                      const Pack (&G)[Frame::dim][8], Pack r,
                                                      ReadView map, int g) {
  constexpr int D = Frame::dim;
  MeanGradient<Frame> out;
  for (int i = 0; i < D; ++i)
    for (int a = 0; a < D; ++a) out.of[i][a] = fnma(Pack(0.5), G[a][4 + i], G[a][i]);
  if constexpr (Configuration::fixed) {
    const InverseMap<D> inverse = inverse_map<D>(map, g);
    for (int i = 0; i < D; ++i) {
      Pack row[D];
      for (int j = 0; j < D; ++j) {
        row[j] = 0.0;
        for (int a = 0; a < D; ++a) row[j] = fma(out.of[i][a], inverse.m[a][j], row[j]);
      }
      for (int j = 0; j < D; ++j) out.of[i][j] = row[j];
    }
  }
  for (int i = 0; i < D; ++i) out.trace += out.of[i][i];
  if constexpr (Frame::hoop) {
    out.hoop = fnma(Pack(0.5), V[4], V[0]) / r;
    out.trace += out.hoop;
  }
  return out;
}

/// s : Lbar of the deviator `s`.
template <class Frame>
KRATER_FORCE_INLINE Pack deviator_power(ReadView s, const MeanGradient<Frame>& L, int g) {
  constexpr int D = Frame::dim;
  Pack power = 0.0;
  for (int i = 0; i < D; ++i) {
    const int I = tensor_axis<D>(i);
    power = fma(s(g, I), L.of[i][i], power);
    for (int a = i + 1; a < D; ++a)
      power = fma(s(g, voigt(I, tensor_axis<D>(a))), L.of[i][a] + L.of[a][i], power);
  }
  if constexpr (Frame::hoop) power = fma(s(g, 1), L.hoop, power);
  return power;
}

}  // namespace krater::inline KRATER_ISA
