// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/grid_pressure.hpp
/// Pressure of fluids and soft solids, integrated over the cells of the grid instead of over the
/// points. Points that left their lattice integrate a uniform pressure to a force g_i = sum V grad
/// S that is not zero, and points that follow it strain: sum V tr L = dt p sum g_i^2/m_i > 0 in
/// every step, whatever the pattern. A solid resists, a fluid drifts without
/// end. With the means of the points at the nodes, P_j = sum S V (p + q) / V_j, V_j = sum S V,
/// and P_h = sum N_j P_j, the smooth part of the pressure is integrated exactly, and the points
/// keep what they add to it:
///   f_i = sum_p V (p + q - P_h) grad S_i + sum_c int_c phi P_h div(N_i) dV,
///   tr_p = tr L + sum_j S_j (D_j - T_j)/V_j,
///   D_j = sum_c int_c phi N_j div(v) dV,   T_j = sum_p S_j V tr L.
/// The second line is the adjoint of the first, so that force and strain exchange exactly what one
/// of them gives: the work is V (p + q) tr_p, with the mean velocity of the step. A uniform
/// pressure gives no force inside; a closed box keeps sum V to round-off, for sum V tr_p = sum D_j
/// = int div(v). N: quadratic B-splines, whatever S is; int over dual cells, where they are
/// polynomials, by 2 Gauss points per axis (exact for a uniform pressure, about the axis too). phi:
/// share of the fluid in what fills a node, contact's other fields included. Cells and the points
/// in them take part by a weight: 1 where every node of the cell is filled to a quarter, by
/// anything, and by the field of the fluid alone, falling to 0. A free surface is then integrated
/// over its points (a flat one cuts off 0.1 of such a cell), and a force on a node vanishes with
/// the mass it would move. Assumptions: current reference; a node's mean pressure is one pressure
/// (fluids that share a field share it). Related: cell-wise pressure of staggered-grid
/// hydrodynamics; Baumgarten & Kamrin 2023 (IJNME 124) for the errors of the points' quadrature.
#include <algorithm>
#include <numbers>

#include "krater/kinematics/mpm/gather.hpp"
#include "krater/kinematics/mpm/gauss_cells.hpp"
#include "krater/kinematics/mpm/pressure_nodes.hpp"

namespace krater::inline KRATER_ISA {

/// Volume that belongs to each node of a tile along one axis, in cells (about the axis [m]).
template <class Frame>
KRATER_FORCE_INLINE void node_lengths(const GridGeometry& grid, double first, int axis,
                                      double* out) {
  const int cells = grid.cells[static_cast<unsigned>(axis)];
  for (int i = 0; i < tile_edge(Frame::dim); ++i) {
    const int index = static_cast<int>(first) + i;
    double length = index == 1 || index == cells + 1 ? 0.5 : 1;
    if (index < 1 || index > cells + 1) length = 1.0 / 48;  // int N of the ghost inside the plane
    if (Frame::hoop && axis == 0) {
      const double r = std::max(0.0, grid.min[0] + grid.h * (index - 1));
      // on the axis int N_0 r dr = 13/64 h^2
      length = index == 1 && grid.min[0] == 0 ? 13.0 / 64 * grid.h : length * r;
      length *= 2 * std::numbers::pi;
    }
    out[i] = length;
  }
}

/// Filling of a node's volume from which a cell counts.
inline constexpr double kFilled = 0.125;

/// Weight of each cell of the block: 0 where it does not take part.
template <class Frame>
void weigh_cells(const Patch& patch, const GridGeometry& grid, const double* halo, double* out) {
  constexpr int D = Frame::dim, T = tile_edge(D);
  const PatchOrigin origin = origin_of<D>(patch);
  double length[3][T];
  double cell_volume = 1;
  for (int a = 0; a < D; ++a) {
    node_lengths<Frame>(grid, origin.first[a], a, length[a]);
    cell_volume *= grid.h;
  }
  for (int c = 0; c < kBlockNodes; ++c) {
    const CellPlace<D> place{c};
    double weight = 1;
    for (int a = 0; a < D; ++a) {
      const int middle = static_cast<int>(origin.first[a]) + place.i[a] + 1;
      if (middle < 1 || middle > grid.cells[static_cast<unsigned>(a)] + 1) weight = 0;
    }
    for (int n = 0; weight > 0 && n < power_of_three<D>; ++n) {
      double volume = cell_volume;
      for (int a = D - 1, rest = n; a >= 0; --a, rest /= 3)
        volume *= length[a][place.i[a] + rest % 3];
      const double* node = halo + kNodeDoubles * (place.tile + node_offset<D>(n));
      const double least = kFilled * volume, fill = node[kNodeReach];
      weight = std::min({weight, fill > least ? fill / std::max(least, 0.5 * fill) - 1 : 0,
                         fill > 0 ? 2 * node[kNodeOwn] / fill - 1 : 0});
    }
    out[c] = std::max(weight, 0.0);
  }
}

/// What the sweeps over the points of a patch share.
template <class Frame, class Shape>
struct PressureSweep {
  static constexpr int D = Frame::dim;
  Patch& patch;
  const PointColumns& c;
  const SweepSettings& s;
  const SweepScratch& w;
  PatchOrigin origin = origin_of<D>(patch);
  double* tile = patch.pressure_tile.data();
  double* cells = tile + tile_nodes(D) * kNodeDoubles;  ///< weights of the block's cells

  KRATER_FORCE_INLINE ReadView column(int offset) const {
    return state_view(patch, offset, c.stride, w.zeros);
  }
  KRATER_FORCE_INLINE Pack cell_weight(int g) const {
    alignas(64) double index[8];
    store(index, local_cell<D>(*s.geometry, origin, column(c.grid_position), g).index);
    return look_up(cells, index);
  }
  KRATER_FORCE_INLINE void weights(int g, LaneWeights<D>& lw) const {
    compute_weights<D, Shape, false>(*s.geometry, origin, column(c.grid_position),
                                     column(c.half_width), g, lw);
  }
  void clear_tile() const {
    for (int i = 0; i < tile_nodes(D) * kNodeDoubles; i += 8) store(tile + i, Pack(0.0));
  }
  KRATER_FORCE_INLINE void scatter(const LaneWeights<D>& lw, Channels<D>& channels) const {
    transpose8(channels.A);
    for (int a = 0; a < D; ++a) transpose8(channels.B[a]);
    for (int l = 0; l < kLanes; ++l) scatter_point<D, false>(tile, lw, l, channels);
  }
  template <class Call>
  void for_cells(const Call& call) const {
    if (!patch.owns_cells) return;
    for (int cell = 0; cell < kBlockNodes; ++cell)
      if (cells[cell] > 0) call(CellPlace<D>{cell}, cells[cell]);
  }
};

KRATER_FORCE_INLINE void clear(Pack* channels) {
  for (int k = 0; k < 8; ++k) channels[k] = 0.0;
}

/// Nodes hold fillings -> tile: sum S V (p + q), sum S V; and the weights of the cells.
template <class Frame, class Shape>
void collect_pressure(const PressureSweep<Frame, Shape>& sweep) {
  constexpr int D = Frame::dim;
  weigh_cells<Frame>(sweep.patch, *sweep.s.geometry, sweep.w.pressure_halo, sweep.cells);
  sweep.clear_tile();
  LaneWeights<D> lw;
  Channels<D> channels;
  for (int g = 0; g < sweep.patch.points.groups(); ++g) {
    sweep.weights(g, lw);
    const Pack V = sweep.column(sweep.c.mass)(g) / sweep.column(sweep.c.density)(g);
    clear(channels.A);
    for (int a = 0; a < D; ++a) clear(channels.B[a]);
    channels.A[kNodePressure] =
        V * (sweep.column(sweep.c.pressure)(g) + sweep.column(sweep.c.viscous)(g));
    channels.A[kNodeVolume] = V;
    sweep.scatter(lw, channels);
  }
}

/// Nodes hold P and phi -> tile: the force of the cells less that of P_h at the points.
template <class Frame, class Shape>
void force_of_pressure(const PressureSweep<Frame, Shape>& sweep) {
  constexpr int D = Frame::dim;
  const double* halo = sweep.w.pressure_halo;
  sweep.clear_tile();
  LaneWeights<D> lw;
  Channels<D> channels;
  PointSums<D> sums;
  for (int g = 0; g < sweep.patch.points.groups(); ++g) {
    sweep.weights(g, lw);
    gather_group<D>(halo, lw, sums);
    const Pack V = sweep.column(sweep.c.mass)(g) / sweep.column(sweep.c.density)(g);
    const Pack less = -(sweep.cell_weight(g) * V * sums.V[kNodePressure]);
    clear(channels.A);
    if constexpr (Frame::hoop) channels.A[kNodeForce] = less / sweep.column(sweep.c.position)(g, 0);
    for (int a = 0; a < D; ++a) {
      clear(channels.B[a]);
      channels.B[a][kNodeForce + a] = less;
    }
    sweep.scatter(lw, channels);
  }
  sweep.for_cells([&](const CellPlace<D>& place, double part) {
    using Cell = GaussCell<Frame>;
    const Cell cell{*sweep.s.geometry, sweep.origin, place};
    const double* node = halo + kNodeDoubles * place.tile;
    double* out = sweep.tile + kNodeDoubles * place.tile;
    double P[Cell::points], share[Cell::points], push[Cell::points];
    cell.to_points(node, kNodePressure, P);
    cell.to_points(node, kNodeShare, share);
    for (int q = 0; q < Cell::points; ++q) push[q] = part * cell.weight[q] * share[q] * P[q];
    cell.template to_nodes<0>(push, out, kNodeForce);
    cell.template to_nodes<1>(push, out, kNodeForce + 1);
    if constexpr (D == 3) cell.template to_nodes<2>(push, out, kNodeForce + 2);
    if constexpr (Frame::hoop) {
      for (int q = 0; q < Cell::points; ++q) push[q] /= cell.r[q];
      cell.to_nodes(push, out, kNodeForce);
    }
  });
}

/// Nodes hold v+ (halo), P and phi (pressure_halo) -> tile: D_j - T_j.
template <class Frame, class Shape>
void sum_dilatation(const PressureSweep<Frame, Shape>& sweep) {
  constexpr int D = Frame::dim;
  const double *halo = sweep.w.halo, *shares = sweep.w.pressure_halo;
  sweep.clear_tile();
  LaneWeights<D> lw;
  Channels<D> channels;
  PointSums<D> sums;
  for (int g = 0; g < sweep.patch.points.groups(); ++g) {
    sweep.weights(g, lw);
    gather_group<D>(halo, lw, sums);
    Pack trace = sums.G[0][0], change = sums.G[0][4];
    for (int a = 1; a < D; ++a) {
      trace += sums.G[a][a];
      change += sums.G[a][4 + a];
    }
    if constexpr (Frame::hoop) {
      const Pack r = sweep.column(sweep.c.position)(g, 0);
      trace += sums.V[0] / r;
      change += sums.V[4] / r;
    }
    const Pack V = sweep.column(sweep.c.mass)(g) / sweep.column(sweep.c.density)(g);
    clear(channels.A);
    for (int a = 0; a < D; ++a) clear(channels.B[a]);
    const Pack part = sweep.cell_weight(g) * V;
    channels.A[kNodeDilatation] = -(part * trace);
    channels.A[kNodeWorkRate] = -(part * fnma(Pack(0.5), change, trace));
    sweep.scatter(lw, channels);
  }
  sweep.for_cells([&](const CellPlace<D>& place, double part) {
    using Cell = GaussCell<Frame>;
    const Cell cell{*sweep.s.geometry, sweep.origin, place};
    const double* node = halo + kNodeDoubles * place.tile;
    double* out = sweep.tile + kNodeDoubles * place.tile;
    double share[Cell::points], flux[Cell::points], work[Cell::points];
    cell.divergence(node, 0, flux);
    cell.divergence(node, 4, work);  // of dv
    cell.to_points(shares + kNodeDoubles * place.tile, kNodeShare, share);
    for (int q = 0; q < Cell::points; ++q) {
      const double weight = part * cell.weight[q] * share[q];
      work[q] = weight * (flux[q] - 0.5 * work[q]);
      flux[q] *= weight;
    }
    cell.to_nodes(flux, out, kNodeDilatation);
    cell.to_nodes(work, out, kNodeWorkRate);
  });
}

/// Nodes hold (D_j - T_j)/V_j -> the points' sum S of it, into the local record. `works`: the same
/// of the mean velocity, times the pressure, is part of the work that the points' energy receives.
template <bool works, class Frame, class Shape>
void correct_dilatation(const PressureSweep<Frame, Shape>& sweep) {
  constexpr int D = Frame::dim;
  const WriteView out{sweep.w.local + sweep.c.local_correction, sweep.c.local_stride};
  LaneWeights<D> lw;
  PointSums<D> sums;
  for (int g = 0; g < sweep.patch.points.groups(); ++g) {
    sweep.weights(g, lw);
    gather_group<D>(sweep.w.pressure_halo, lw, sums);
    out.set(g, sums.V[kNodeDilatation]);
    if constexpr (works) {
      const Pack P = sweep.column(sweep.c.pressure)(g) + sweep.column(sweep.c.viscous)(g),
                 v = 1.0 / sweep.column(sweep.c.density)(g);
      const WriteView e{sweep.patch.points.data() + sweep.c.energy, sweep.c.stride};
      e.set(g, fnma(sweep.s.dt * v * P, sums.V[kNodeWorkRate], e(g)));
    }
  }
}

}  // namespace krater::inline KRATER_ISA
