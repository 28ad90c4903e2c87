// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/scatter.hpp
/// particles_to_grid of one patch:
///   m_i = sum S m_p,  p_i = sum S m_p (v_p + L_p (x_i - x_p)),  V_i = sum S V_p,
///   f_i = sum (S m_p b_p - V_p sigma_p . grad S);  axisymmetric: f_r -= V_p sigma_tt S/r_p.
/// On a fixed reference V sigma F^-T takes the place of V sigma (mpm/configuration.hpp).
#include "krater/kinematics/frames.hpp"
#include "krater/kinematics/mpm/cells.hpp"
#include "krater/kinematics/mpm/configuration.hpp"
#include "krater/kinematics/mpm/node_sums.hpp"

namespace krater::inline KRATER_ISA {

/// A column of the state, or zeros where it does not exist.
KRATER_FORCE_INLINE ReadView state_view(const Patch& patch, int offset, int stride,
                                        const double* zeros) {
  return offset < 0 ? ReadView{zeros, 0} : ReadView{patch.points.data() + offset, stride};
}

/// What the first pass over a patch leaves for the second, in SweepScratch::cells and ::pressures.
struct ForceAverages {
  const double* beta;   ///< per cell
  const double* mean;   ///< per cell: sum V (p + q) / sum V
  const double* cells;  ///< 8 per group: cell of each point
};

/// Ask for part of the tile, which comes from memory, while group `g` is looked at.
template <int Dim>
KRATER_FORCE_INLINE void fetch_tile(double* tile, int g) {
  constexpr int nodes = 12;  // a full patch has 20 to 64 groups for 216 or 100 nodes
  for (int n = nodes * g; n < nodes * (g + 1) && n < tile_nodes(Dim); ++n)
    __builtin_prefetch(tile + kNodeDoubles * n, 1);
}

/// First pass: every point of the patch, padding included, lies in its block (what follows indexes
/// memory with positions), and the cell averages of the pressure p + q that enters the force. One
/// pass, because its cost is the way of the columns from memory.
template <int Dim>
bool first_pass(Patch& patch, const PointColumns& c, const SweepSettings& s,
                const SweepScratch& w) {
  const auto column = [&](int offset) { return state_view(patch, offset, c.stride, w.zeros); };
  const ReadView x = column(c.grid_position), p = column(c.pressure), q = column(c.viscous),
                 m = column(c.mass), rho = column(c.density), indicator = column(c.indicator),
                 failed = column(c.failed);
  const PatchOrigin origin = origin_of<Dim>(patch);
  const CellSums sums{w.cells, w.cells + kBlockNodes};
  double* beta = patch.beta.data();
  if (s.average_cells) {
    sums.clear();
    clear_cells(beta);
  }
  for (int g = 0; g < patch.points.groups(); ++g) {
    fetch_tile<Dim>(patch.tile.data(), g);
    const LocalCell cell = local_cell<Dim>(*s.geometry, origin, x, g);
    if (!all(cell.inside)) {
      patch.result.fault = {FaultKind::not_finite_input, g, bits(!cell.inside)};
      return false;
    }
    if (!s.average_cells) continue;
    double* cells = w.pressures + kLanes * g;
    store(cells, cell.index);
    sums.add(cells, m(g) / rho(g), p(g) + q(g));
    note_shock(cells, select(failed(g) > Pack(0.5), Pack(kShockOn), indicator(g)), beta);
  }
  if (s.average_cells) {
    sums.divide();
    shock_switch(beta);
  }
  return true;
}

/// Pressure that enters the force: p + q, cell-averaged where the flow is smooth.
KRATER_FORCE_INLINE Pack force_pressure(const ForceAverages* averages, Pack own, int g) {
  if (averages == nullptr) return own;
  const double* cells = averages->cells + kLanes * g;
  return fma(look_up(averages->beta, cells), look_up(averages->mean, cells) - own, own);
}

template <class Frame, bool Affine, class Configuration>
KRATER_FORCE_INLINE Pack load_channels(const Patch& patch, const PointColumns& c,
                                       const SweepScratch& w, const ForceAverages* averages, int g,
                                       Channels<Frame::dim>& out) {
  constexpr int D = Frame::dim;
  const auto column = [&](int offset) { return state_view(patch, offset, c.stride, w.zeros); };
  const ReadView x = column(c.position), v = column(c.velocity), b = column(c.body_acceleration);
  const ReadView stress = column(c.stress), L = column(c.affine);
  const Pack m = column(c.mass)(g), V = m / column(c.density)(g),
             P = force_pressure(averages, column(c.pressure)(g) + column(c.viscous)(g), g);
  const auto sigma = [&](int i, int j) {
    return i == j ? stress(g, voigt(i, j)) - P : stress(g, voigt(i, j));
  };
  const Pack zero = 0.0;
  Pack check = m + V;
  for (Pack& channel : out.A) channel = zero;
  out.A[0] = m;
  out.A[7] = V;
  for (int a = 0; a < D; ++a) {
    out.A[1 + a] = m * v(g, a);
    out.A[4 + a] = m * b(g, a);
    check += out.A[1 + a] + out.A[4 + a];
  }
  if constexpr (Frame::hoop) {
    out.A[4] = fnma(V, sigma(1, 1) / x(g, 0), out.A[4]);
    check += out.A[4];
  }
  InverseMap<D> inverse;
  if constexpr (Configuration::fixed) inverse = inverse_map<D>(column(c.map), g);
  const auto on_grid = [&](int i, int a) {  // component of J sigma F^-T; sigma where F = I
    if constexpr (!Configuration::fixed) return sigma(tensor_axis<D>(i), tensor_axis<D>(a));
    Pack first = 0.0;
    for (int j = 0; j < D; ++j)
      first = fma(sigma(tensor_axis<D>(i), tensor_axis<D>(j)), inverse.m[a][j], first);
    return first;
  };
  for (int a = 0; a < D; ++a) {
    for (Pack& channel : out.B[a]) channel = zero;
    for (int i = 0; i < D; ++i) {
      if constexpr (Affine) {
        out.B[a][1 + i] = m * L(g, D * i + a);
        check += out.B[a][1 + i];
      }
      out.B[a][4 + i] = -(V * on_grid(i, a));
      check += out.B[a][4 + i];
    }
    transpose8(out.B[a]);
  }
  transpose8(out.A);
  return check;
}

template <class Frame, class Shape, bool Affine, class Configuration>
void scatter_patch(Patch& patch, const BodyKernelData& body, const SweepSettings& s,
                   const SweepScratch& w) {
  constexpr int D = Frame::dim;
  const PointColumns& c = body.columns;
  const ReadView x = state_view(patch, c.grid_position, c.stride, w.zeros);
  if (!first_pass<D>(patch, c, s, w)) return;
  const ForceAverages averages{patch.beta.data(), w.cells + kBlockNodes, w.pressures};
  double* tile = patch.tile.data();
  for (int i = 0; i < tile_nodes(D) * kNodeDoubles; i += 8) store(tile + i, Pack(0.0));
  const PatchOrigin origin = origin_of<D>(patch);
  const ReadView half_width = state_view(patch, c.half_width, c.stride, w.zeros);
  LaneWeights<D> lw;
  Channels<D> channels;
  for (int g = 0; g < patch.points.groups(); ++g) {
    compute_weights<D, Shape, Affine>(*s.geometry, origin, x, half_width, g, lw);
    const Pack check = load_channels<Frame, Affine, Configuration>(
        patch, c, w, s.average_cells ? &averages : nullptr, g, channels);
    const unsigned bad = bits(!is_finite(check) & first_lanes(patch.points.count() - kLanes * g));
    if (bad != 0 && patch.result.fault.kind == FaultKind::none)
      patch.result.fault = {FaultKind::not_finite_input, g, bad};
    for (int l = 0; l < kLanes; ++l) scatter_point<D, Affine>(tile, lw, l, channels);
  }
}

}  // namespace krater::inline KRATER_ISA
