// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/gauss_cells.hpp
/// Dual cells, those about the nodes, where quadratic B-splines are polynomials: integrals over
/// them by two Gauss points per axis. Cells at a side of the domain are cut in half there.
#include <numbers>

#include "krater/kinematics/frames.hpp"
#include "krater/kinematics/mpm/weights.hpp"

namespace krater::inline KRATER_ISA {

/// Gauss points of a dual cell along one axis: the whole cell, or its half inside the domain.
struct CellRule {
  double N[2][3], d[2][3];  ///< of the three nodes
  double weight = 0;  ///< of each of the two points, in cells; 0: the cell is not in the domain
  double at[2];       ///< from the middle node, in cells
};

KRATER_FORCE_INLINE CellRule cell_rule(int middle, int cells, double inv_h) {
  CellRule out;
  if (middle < 1 || middle > cells + 1) return out;
  const double low = middle == 1 ? 0.0 : -0.5, high = middle == cells + 1 ? 0.0 : 0.5;
  out.weight = 0.5 * (high - low);
  constexpr double gauss = 0.57735026918962576;
  for (int q = 0; q < 2; ++q) {
    const double t = 0.5 * (low + high) + (q == 0 ? -gauss : gauss) * 0.5 * (high - low);
    out.at[q] = t;
    out.N[q][0] = 0.5 * (0.5 - t) * (0.5 - t);
    out.N[q][1] = 0.75 - t * t;
    out.N[q][2] = 0.5 * (0.5 + t) * (0.5 + t);
    out.d[q][0] = -(0.5 - t) * inv_h;
    out.d[q][1] = -2 * t * inv_h;
    out.d[q][2] = (0.5 + t) * inv_h;
  }
  return out;
}

template <int Dim>
constexpr int power_of_three = Dim == 3 ? 27 : 9;

/// Index of a cell of a block along each axis, and in the block's tile.
template <int Dim>
struct CellPlace {
  int i[3] = {0, 0, 0};
  int tile = 0;
  KRATER_FORCE_INLINE explicit CellPlace(int cell) {
    constexpr int E = block_edge(Dim);
    for (int a = Dim - 1, rest = cell; a >= 0; --a, rest /= E) i[a] = rest % E;
    for (int a = 0; a < Dim; ++a) tile = tile * tile_edge(Dim) + i[a];
  }
};
/// Offset in the tile of node n of a cell, in nodes.
template <int Dim>
constexpr int node_offset(int n) {
  constexpr int T = tile_edge(Dim);
  return Dim == 3 ? (n / 9 * T + n / 3 % 3) * T + n % 3 : n / 3 * T + n % 3;
}

/// The 2^D Gauss points of a dual cell. Sums over its 3^D nodes go axis by axis: in space 57
/// products a point and field become 14.
template <class Frame>
class GaussCell {
 public:
  static constexpr int D = Frame::dim, points = 1 << D;
  double weight[points];  ///< [m^3]
  double r[points];       ///< about the axis [m]

  KRATER_FORCE_INLINE GaussCell(const GridGeometry& grid, const PatchOrigin& origin,
                                const CellPlace<D>& place) {
    double volume = 1;
    for (int a = 0; a < D; ++a) {
      rule_[a] = cell_rule(static_cast<int>(origin.first[a]) + place.i[a] + 1,
                           grid.cells[static_cast<unsigned>(a)], grid.inv_h);
      volume *= grid.h * rule_[a].weight;
    }
    for (int q = 0; q < points; ++q) {
      weight[q] = volume;
      r[q] = 1;
      if constexpr (Frame::hoop) {
        r[q] = grid.min[0] + grid.h * (origin.first[0] + place.i[0] + rule_[0].at[q >> (D - 1)]);
        weight[q] *= 2 * std::numbers::pi * r[q];
      }
    }
  }
  /// out[point] = sum of N over the nodes times a slot of theirs; along axis `slope` of dN/dx.
  template <int slope = -1>
  KRATER_FORCE_INLINE void to_points(const double* first_node, int slot, double* out) const {
    double even[power_of_three<D>], odd[power_of_three<D>];
    for (int n = 0; n < power_of_three<D>; ++n)
      even[n] = first_node[kNodeDoubles * node_offset<D>(n) + slot];
    if constexpr (D == 3) {
      gather_axis<D - 1>(table<slope>(D - 1), even, odd);
      gather_axis<1>(table<slope>(1), odd, even);
      gather_axis<0>(table<slope>(0), even, out);
    } else {
      gather_axis<1>(table<slope>(1), even, odd);
      gather_axis<0>(table<slope>(0), odd, out);
    }
  }
  /// out[point] = div of the vector that begins at a slot of the nodes.
  KRATER_FORCE_INLINE void divergence(const double* first_node, int slot, double* out) const {
    double term[points];
    const auto add = [&] {
      for (int q = 0; q < points; ++q) out[q] += term[q];
    };
    to_points<0>(first_node, slot, out);
    to_points<1>(first_node, slot + 1, term);
    add();
    if constexpr (D == 3) {
      to_points<2>(first_node, slot + 2, term);
      add();
    }
    if constexpr (Frame::hoop) {
      to_points(first_node, slot, term);
      for (int q = 0; q < points; ++q) term[q] /= r[q];
      add();
    }
  }
  /// The adjoint of to_points: adds values of the points to a slot of the nodes.
  template <int slope = -1>
  KRATER_FORCE_INLINE void to_nodes(const double* values, double* first_node, int slot) const {
    double even[power_of_three<D>], odd[power_of_three<D>];
    scatter_axis<0>(table<slope>(0), values, even);
    scatter_axis<1>(table<slope>(1), even, odd);
    const double* sums = odd;
    if constexpr (D == 3) {
      scatter_axis<D - 1>(table<slope>(D - 1), odd, even);
      sums = even;
    }
    for (int n = 0; n < power_of_three<D>; ++n)
      first_node[kNodeDoubles * node_offset<D>(n) + slot] += sums[n];
  }

 private:
  using Table = double[2][3];
  template <int slope>
  KRATER_FORCE_INLINE const Table& table(int axis) const {
    return axis == slope ? rule_[axis].d : rule_[axis].N;
  }
  template <int axis>
  static constexpr int outer = axis == 0 ? 1 : (axis == 1 ? 3 : 9);

  template <int axis>
  KRATER_FORCE_INLINE static void gather_axis(const Table& T, const double* in, double* out) {
    constexpr int inner = points >> (axis + 1);
    for (int o = 0; o < outer<axis>; ++o)
      for (int q = 0; q < 2; ++q)
        for (int i = 0; i < inner; ++i) {
          const double* x = in + 3 * o * inner + i;
          out[(2 * o + q) * inner + i] =
              T[q][0] * x[0] + T[q][1] * x[inner] + T[q][2] * x[2 * inner];
        }
  }
  template <int axis>
  KRATER_FORCE_INLINE static void scatter_axis(const Table& T, const double* in, double* out) {
    constexpr int inner = points >> (axis + 1);
    for (int o = 0; o < outer<axis>; ++o)
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < inner; ++i) {
          const double* x = in + 2 * o * inner + i;
          out[(3 * o + k) * inner + i] = T[0][k] * x[0] + T[1][k] * x[inner];
        }
  }

  CellRule rule_[D];
};

}  // namespace krater::inline KRATER_ISA
