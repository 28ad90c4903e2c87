// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/weights.hpp
/// Weights of 8 points at a time (theory 21): they are computed over points, the sums that take
/// them run over the 8 channels of a node record (kinematics/mpm/node_sums.hpp).
#include "krater/grid/blocks.hpp"
#include "krater/grid/shape.hpp"
#include "krater/kinematics/mpm/kernels.hpp"
#include "krater/points/batch.hpp"

namespace krater::inline KRATER_ISA {

/// Per axis and knot a row of 8 points: weight w, gradient d [1/m], lever xw = (x_i - x_p) w [m].
template <int Dim>
struct LaneWeights {
  alignas(64) double w[Dim][Support::support][8];
  alignas(64) double d[Dim][Support::support][8];
  alignas(64) double xw[Dim][Support::support][8];
  alignas(64) double first_node[8];  ///< offset of the first node in the tile, in doubles
  alignas(64) double cell[8];        ///< index of the point's cell in its block
  /// Along the last axis, from the middle of the point's cell [cells]: phi, 2 phi, and where the
  /// quadratics of the first row lie. Quadratic B-splines only.
  alignas(64) double phi[8], twice_phi[8], first_quadratic[8];
};

/// Where a patch lies: storage index of its first node along each axis.
struct PatchOrigin {
  double first[3];
};
template <int Dim>
KRATER_FORCE_INLINE PatchOrigin origin_of(const Patch& patch) {
  PatchOrigin o{};
  for (int a = 0; a < Dim; ++a)
    o.first[a] = static_cast<double>(patch.key.i[static_cast<unsigned>(a)] * block_edge(Dim));
  return o;
}

/// Knot coordinate, the same expression as GridGeometry::knots.
KRATER_FORCE_INLINE Pack knots(const GridGeometry& grid, Pack x, int axis) {
  return (x - grid.min[static_cast<unsigned>(axis)]) * grid.inv_h + grid.scale - grid.origin;
}

/// Index of a point's cell in its block, and which lanes lie in the block at all.
struct LocalCell {
  Pack index;
  Mask inside;
};
template <int Dim>
KRATER_FORCE_INLINE LocalCell local_cell(const GridGeometry& grid, const PatchOrigin& origin,
                                         ReadView x, int g) {
  LocalCell out{0.0, first_lanes(kLanes)};
  for (int a = 0; a < Dim; ++a) {
    const Pack cell = Support::base(knots(grid, x(g, a), a)) - origin.first[a];
    const auto edge = static_cast<double>(block_edge(Dim));
    out.inside = out.inside & (cell >= Pack(0.0)) & (cell < Pack(edge));
    out.index = out.index * edge + cell;
  }
  return out;
}

template <int Dim, class Shape, bool Lever>
KRATER_FORCE_INLINE void compute_weights(const GridGeometry& grid, const PatchOrigin& origin,
                                         ReadView x, ReadView half_width, int g,
                                         LaneWeights<Dim>& out) {
  constexpr int z = Dim - 1;
  Pack local = 0.0, cell = 0.0;
  for (int a = 0; a < Dim; ++a) {
    const Pack t = knots(grid, x(g, a), a);
    const Pack base = Shape::base(t);
    const Pack f = t - base + 0.5, in_block = base - origin.first[a];
    if constexpr (Shape::quadratic_in_cell)
      if (a == z) {
        const Pack phi = f - 1.0, first = local * static_cast<double>(quadratic_row(Dim));
        store(out.phi, phi);
        store(out.twice_phi, 2.0 * phi);
        store(out.first_quadratic, fma(Pack(3.0 * kNodeDoubles), in_block, first));
      }
    Pack lp = 0.5;
    if constexpr (Shape::has_width) lp = min(half_width(g, a) * grid.inv_h, Pack(0.5));
    const Knots k = Shape::at(f, lp);
    for (int i = 0; i < Shape::support; ++i) {
      store(out.w[a][i], k.w[i]);
      store(out.d[a][i], k.d[i] * grid.inv_h);
      if constexpr (Lever) store(out.xw[a][i], (static_cast<double>(i) - f) * grid.h * k.w[i]);
    }
    local = local * static_cast<double>(tile_edge(Dim)) + in_block;
    cell = cell * static_cast<double>(block_edge(Dim)) + in_block;
  }
  store(out.first_node, local * static_cast<double>(kNodeDoubles));
  store(out.cell, cell);
}

}  // namespace krater::inline KRATER_ISA
