// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/weights.hpp
/// Weights of 8 points at a time, and the tensor-product scatter and gather of one point over its
/// nodes (theory 21): weights are computed over points, the sums run over the 8 channels of
/// a node record.
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
  Pack local = 0.0;
  for (int a = 0; a < Dim; ++a) {
    const Pack t = knots(grid, x(g, a), a);
    const Pack base = Shape::base(t);
    const Pack f = t - base + 0.5;
    Pack lp = 0.5;
    if constexpr (Shape::has_width) lp = min(half_width(g, a) * grid.inv_h, Pack(0.5));
    const Knots k = Shape::at(f, lp);
    for (int i = 0; i < Shape::support; ++i) {
      store(out.w[a][i], k.w[i]);
      store(out.d[a][i], k.d[i] * grid.inv_h);
      if constexpr (Lever) store(out.xw[a][i], (static_cast<double>(i) - f) * grid.h * k.w[i]);
    }
    local = local * static_cast<double>(tile_edge(Dim)) + (base - origin.first[a]);
  }
  store(out.first_node, local * static_cast<double>(kNodeDoubles));
}

/// node += S A + sum_a (dS or lever weight)_a B_a over the nodes of point `lane`. With Lever
/// the momentum channels 0-3 of B_a carry m L and weigh with the lever, the force channels 4-7 with
/// the gradient.
template <int Dim, bool Lever>
KRATER_FORCE_INLINE void scatter_point(double* tile, const LaneWeights<Dim>& lw, int lane, Pack A,
                                       const Pack (&B)[Dim]) {
  const auto weight = [&](int a, int i) { return Pack(lw.w[a][i][lane]); };
  const auto slope = [&](int a, int i) {
    if constexpr (Lever)
      return blend_low<4>(Pack(lw.xw[a][i][lane]), Pack(lw.d[a][i][lane]));
    else
      return Pack(lw.d[a][i][lane]);
  };
  constexpr int N = Support::support, T = tile_edge(Dim), z = Dim - 1;
  double* first = tile + static_cast<int>(lw.first_node[lane]);
  Pack wz[N], gz[N];
  for (int k = 0; k < N; ++k) {
    wz[k] = weight(z, k);
    gz[k] = slope(z, k);
  }
  const auto row = [&](double* node, Pack P, Pack Q) {
    for (int k = 0; k < N; ++k)
      store(node + 8 * k, fma(wz[k], P, fma(gz[k], Q, load(node + 8 * k))));
  };
#pragma GCC unroll 8
  for (int i = 0; i < N; ++i) {
    const Pack wx = weight(0, i), gx = slope(0, i);
    const Pack Ai = fma(wx, A, gx * B[0]);
    if constexpr (Dim == 2) {
      row(first + 8 * T * i, Ai, wx * B[1]);
    } else {
      const Pack Bi = wx * B[1], Ci = wx * B[2];
#pragma GCC unroll 8
      for (int j = 0; j < N; ++j)
        row(first + 8 * T * (T * i + j), fma(weight(1, j), Ai, slope(1, j) * Bi),
            weight(1, j) * Ci);
    }
  }
}

/// V = sum S n, G_a = sum d_a n over the nodes of point `lane`.
template <int Dim>
struct Gathered {
  Pack V, G[Dim];
};
template <int Dim>
KRATER_FORCE_INLINE Gathered<Dim> gather_point(const double* halo, const LaneWeights<Dim>& lw,
                                               int lane) {
  const auto w = [&](int a, int i) { return Pack(lw.w[a][i][lane]); };
  const auto d = [&](int a, int i) { return Pack(lw.d[a][i][lane]); };
  constexpr int N = Support::support, T = tile_edge(Dim), z = Dim - 1;
  const double* first = halo + static_cast<int>(lw.first_node[lane]);
  Pack wz[N], dz[N];
  for (int k = 0; k < N; ++k) {
    wz[k] = w(z, k);
    dz[k] = d(z, k);
  }
  Gathered<Dim> out;
  out.V = 0.0;
  for (int a = 0; a < Dim; ++a) out.G[a] = 0.0;
#pragma GCC unroll 8
  for (int i = 0; i < N; ++i) {
    Pack T0 = 0.0, T1 = 0.0, T2 = 0.0;
    const auto add_row = [&](const double* node, Pack& value, Pack& slope) {
      const Pack last = load(node + 8 * (N - 1));
      value = wz[N - 1] * last;
      slope = dz[N - 1] * last;
      for (int k = N - 2; k >= 0; --k) {
        const Pack n = load(node + 8 * k);
        value = fma(wz[k], n, value);
        slope = fma(dz[k], n, slope);
      }
    };
    if constexpr (Dim == 2) {
      add_row(first + 8 * T * i, T0, T1);
    } else {
#pragma GCC unroll 8
      for (int j = 0; j < N; ++j) {
        Pack value, slope;
        add_row(first + 8 * T * (T * i + j), value, slope);
        T0 = fma(w(1, j), value, T0);
        T1 = fma(d(1, j), value, T1);
        T2 = fma(w(1, j), slope, T2);
      }
    }
    const Pack wx = w(0, i);
    out.V = fma(wx, T0, out.V);
    out.G[0] = fma(d(0, i), T0, out.G[0]);
    out.G[1] = fma(wx, T1, out.G[1]);
    if constexpr (Dim == 3) out.G[2] = fma(wx, T2, out.G[2]);
  }
  return out;
}

}  // namespace krater::inline KRATER_ISA
