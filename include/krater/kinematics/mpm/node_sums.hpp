// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/node_sums.hpp
/// Tensor-product scatter and gather of one point over the channels of its nodes (theory 21), one
/// register of channels after the other: what a point needs at once then stays in registers.
///
/// Quadratic B-splines are gathered along the last axis as what they are within a cell. About its
/// middle, phi = x - x_1 in cells, |phi| <= 1/2, the nodes n_0, n_1, n_2 give
///   value = c_0 + phi (c_1 + phi c_2),   slope = (c_1 + 2 phi c_2)/h,
///   c_0 = (n_0 + 6 n_1 + n_2)/8,  c_1 = (n_2 - n_0)/2,  c_2 = (n_0 - 2 n_1 + n_2)/2,
/// three operations a row for the six of the weights; the coefficients are made once for all points
/// of a patch. A constant comes out exactly, with slope zero.
#include "krater/core/simd_register.hpp"
#include "krater/kinematics/mpm/weights.hpp"

namespace krater::inline KRATER_ISA {

/// Slope weight of a node; with Lever the momentum channels 0-3 weigh with the lever.
template <int Dim, bool Lever, int Part>
KRATER_FORCE_INLINE Register slope_weight(const LaneWeights<Dim>& lw, int lane, int a, int i) {
  if constexpr (Lever)
    return part_of_halves<Part>(lw.xw[a][i][lane], lw.d[a][i][lane]);
  else
    return Register(lw.d[a][i][lane]);
}

/// Channel vectors of 8 points: value part A, slope parts B_a.
template <int Dim>
struct Channels {
  alignas(64) Pack A[8];
  alignas(64) Pack B[Dim][8];
};

template <int Dim, bool Lever, int Part>
KRATER_FORCE_INLINE void scatter_part(double* tile, const LaneWeights<Dim>& lw, int lane,
                                      const Channels<Dim>& c) {
  const auto slope_part = [&](int a) { return part_of<Part>(c.B[a][lane]); };
  const auto weight = [&](int a, int i) { return Register(lw.w[a][i][lane]); };
  const auto slope = [&](int a, int i) { return slope_weight<Dim, Lever, Part>(lw, lane, a, i); };
  constexpr int N = Support::support, T = tile_edge(Dim), z = Dim - 1;
  double* first = tile + static_cast<int>(lw.first_node[lane]) + Part * kRegisterLanes;
  Register wz[N], gz[N];
  for (int k = 0; k < N; ++k) {
    wz[k] = weight(z, k);
    gz[k] = slope(z, k);
  }
  const auto row = [&](double* node, Register P, Register Q) {
    for (int k = 0; k < N; ++k)
      store(node + 8 * k, fma(wz[k], P, fma(gz[k], Q, load_register(node + 8 * k))));
  };
#pragma GCC unroll 8
  for (int i = 0; i < N; ++i) {
    const Register wx = weight(0, i), gx = slope(0, i);
    const Register Ai = fma(wx, part_of<Part>(c.A[lane]), gx * slope_part(0));
    if constexpr (Dim == 2) {
      row(first + 8 * T * i, Ai, wx * slope_part(1));
    } else {
      const Register Bi = wx * slope_part(1), Ci = wx * slope_part(2);
#pragma GCC unroll 8
      for (int j = 0; j < N; ++j)
        row(first + 8 * T * (T * i + j), fma(weight(1, j), Ai, slope(1, j) * Bi),
            weight(1, j) * Ci);
    }
  }
}

/// node += S A + sum_a (dS or lever weight)_a B_a over the nodes of point `lane`. With Lever
/// the momentum channels 0-3 of B_a carry m L and weigh with the lever, the force channels 4-7 with
/// the gradient.
template <int Dim, bool Lever>
KRATER_FORCE_INLINE void scatter_point(double* tile, const LaneWeights<Dim>& lw, int lane,
                                       const Channels<Dim>& c) {
  scatter_part<Dim, Lever, 0>(tile, lw, lane, c);
  if constexpr (kRegisterParts == 2) scatter_part<Dim, Lever, 1>(tile, lw, lane, c);
}

/// Nodal sums of 8 points, one pack per channel: V[c] value, G[a][c] slope along axis a. While they
/// are gathered, one pack per point.
template <int Dim>
struct PointSums {
  Pack V[8], G[Dim][8];
};

/// Rows of nodes along the last axis, by their weights.
template <int Dim, int Part>
struct NodeRows {
  static constexpr int N = Support::support, T = tile_edge(Dim), z = Dim - 1;
  const double* first;
  Register w[N], d[N];
  KRATER_FORCE_INLINE NodeRows(const double* halo, const LaneWeights<Dim>& lw, int lane)
      : first{halo + static_cast<int>(lw.first_node[lane]) + Part * kRegisterLanes} {
    for (int k = 0; k < N; ++k) {
      w[k] = Register(lw.w[z][k][lane]);
      d[k] = Register(lw.d[z][k][lane]);
    }
  }
  /// Of row `r` above the point's first: value and slope along the row.
  KRATER_FORCE_INLINE void sum(int r, Register& value, Register& slope) const {
    const double* node = first + kNodeDoubles * T * r;
    const Register last = load_register(node + kNodeDoubles * (N - 1));
    value = w[N - 1] * last;
    slope = d[N - 1] * last;
    for (int k = N - 2; k >= 0; --k) {
      const Register n = load_register(node + kNodeDoubles * k);
      value = fma(w[k], n, value);
      slope = fma(d[k], n, slope);
    }
  }
};

template <int Dim>
void make_quadratics(const double* halo, double* quadratics) {
  constexpr int T = tile_edge(Dim);
  for (int row = 0; row < tile_nodes(Dim) / T; ++row)
    for (int k = 0; k < block_edge(Dim); ++k) {
      const double* node = halo + kNodeDoubles * (T * row + k);
      double* to = quadratics + quadratic_row(Dim) * row + 3 * kNodeDoubles * k;
      const Pack low = load(node), middle = load(node + kNodeDoubles),
                 high = load(node + 2 * kNodeDoubles), ends = low + high;
      store(to, 0.125 * fma(Pack(6.0), middle, ends));
      store(to + kNodeDoubles, 0.5 * (high - low));
      store(to + 2 * kNodeDoubles, 0.5 * fnma(Pack(2.0), middle, ends));
    }
}

/// The same rows as quadratics of a cell.
template <int Dim, int Part>
struct QuadraticRows {
  const double* first;
  Register phi, twice;
  KRATER_FORCE_INLINE QuadraticRows(const double* quadratics, const LaneWeights<Dim>& lw, int lane)
      : first{quadratics + static_cast<int>(lw.first_quadratic[lane]) + Part * kRegisterLanes},
        phi{lw.phi[lane]},
        twice{lw.twice_phi[lane]} {}
  KRATER_FORCE_INLINE void sum(int r, Register& value, Register& slope) const {
    const double* c = first + quadratic_row(Dim) * r;
    const Register c2 = load_register(c + 2 * kNodeDoubles), c1 = load_register(c + kNodeDoubles);
    value = fma(phi, fma(phi, c2, c1), load_register(c));
    slope = fma(twice, c2, c1);
  }
};

/// V = sum S n, G_a = sum d_a n over the nodes of point `lane`. Each part goes to its place at
/// once: GCC copies a Pack of two registers by eight bytes at a time.
template <int Dim, int Part, class Rows>
KRATER_FORCE_INLINE void gather_part(const Rows& rows, const LaneWeights<Dim>& lw, int lane,
                                     PointSums<Dim>& out) {
  const auto w = [&](int a, int i) { return Register(lw.w[a][i][lane]); };
  const auto d = [&](int a, int i) { return Register(lw.d[a][i][lane]); };
  constexpr int N = Support::support, T = tile_edge(Dim);
  Register V(0.0), G[Dim];
  for (int a = 0; a < Dim; ++a) G[a] = V;
#pragma GCC unroll 8
  for (int i = 0; i < N; ++i) {
    Register T0(0.0), T1(0.0), T2(0.0);
    if constexpr (Dim == 2) {
      rows.sum(i, T0, T1);
    } else {
#pragma GCC unroll 8
      for (int j = 0; j < N; ++j) {
        Register value, slope;
        rows.sum(T * i + j, value, slope);
        T0 = fma(w(1, j), value, T0);
        T1 = fma(d(1, j), value, T1);
        T2 = fma(w(1, j), slope, T2);
      }
    }
    const Register wx = w(0, i);
    V = fma(wx, T0, V);
    G[0] = fma(d(0, i), T0, G[0]);
    G[1] = fma(wx, T1, G[1]);
    if constexpr (Dim == 3) G[2] = fma(wx, T2, G[2]);
  }
  set_part<Part>(out.V[lane], V);
  for (int a = 0; a < Dim; ++a) set_part<Part>(out.G[a][lane], G[a]);
}

template <int Dim, template <int, int> class Rows>
KRATER_FORCE_INLINE void gather_lanes(const double* nodes, const LaneWeights<Dim>& lw,
                                      PointSums<Dim>& out) {
  for (int l = 0; l < kLanes; ++l) {
    gather_part<Dim, 0>(Rows<Dim, 0>{nodes, lw, l}, lw, l, out);
    if constexpr (kRegisterParts == 2) gather_part<Dim, 1>(Rows<Dim, 1>{nodes, lw, l}, lw, l, out);
  }
  transpose8(out.V);
  for (int a = 0; a < Dim; ++a) transpose8(out.G[a]);
}

/// From records of the nodes of a tile.
template <int Dim>
KRATER_FORCE_INLINE void gather_group(const double* halo, const LaneWeights<Dim>& lw,
                                      PointSums<Dim>& out) {
  gather_lanes<Dim, NodeRows>(halo, lw, out);
}

/// The nodes of a patch as its points sum over them: quadratics, where the shape is one in a cell.
template <int Dim, class Shape>
struct TileNodes {
  const double* records;
  double inv_h;
  TileNodes(const SweepScratch& w, const GridGeometry& grid)
      : records{Shape::quadratic_in_cell ? w.quadratics : w.halo}, inv_h{grid.inv_h} {
    if constexpr (Shape::quadratic_in_cell) make_quadratics<Dim>(w.halo, w.quadratics);
  }
  KRATER_FORCE_INLINE void gather(const LaneWeights<Dim>& lw, PointSums<Dim>& out) const {
    if constexpr (Shape::quadratic_in_cell) {
      gather_lanes<Dim, QuadraticRows>(records, lw, out);
      for (Pack& slope : out.G[Dim - 1]) slope = slope * inv_h;  // was per cell
    } else {
      gather_group<Dim>(records, lw, out);
    }
  }
};

}  // namespace krater::inline KRATER_ISA
