// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file grid/geometry.hpp
/// Where the nodes, knots and blocks of one level of the grid lie. With h_l = 2^-l H and a point's
/// distance x from the lower plane of the domain,
///   t_0 = x/H + 1/2,   t_l = 2^l t_0     counts knots: those of quadratic B-splines lie half way
///                                        between nodes, and every other one of a level is one of
///                                        the level above it, to the last bit;
///   s_l = t_l + 1/2                      counts nodes: "storage".
/// The cell floor(t), a span between knots, is seen by the nodes floor(t) + {0, 1, 2}. A plane of
/// the domain is a node of level 0 (storage 1) and a knot of every finer one: lower side at storage
/// 2^(l-1) + 1/2.
#include <array>
#include <cstddef>
#include <cstdint>

#include "krater/grid/key_index.hpp"
#include "krater/grid/support.hpp"

namespace krater {

inline constexpr int kBlockNodes = 64;  ///< nodes (and cells) of a block: 4^3 or 8^2
constexpr int block_edge(int dimension) { return dimension == 3 ? 4 : 8; }
constexpr int tile_edge(int dimension) { return block_edge(dimension) + Support::support - 1; }
constexpr int tile_nodes(int dimension) {
  const int edge = tile_edge(dimension);
  return dimension == 3 ? edge * edge * edge : edge * edge;
}
constexpr int corner_count(int dimension) { return dimension == 3 ? 8 : 4; }      ///< 2^dim
constexpr int neighbour_count(int dimension) { return dimension == 3 ? 27 : 9; }  ///< 3^dim

/// Division that rounds down, for blocks and levels below zero.
constexpr int floor_div(int i, int by) { return i >= 0 ? i / by : -((by - 1 - i) / by); }

/// Where node n of a block lies among the nodes of its level, which storage coordinates count; the
/// last axis runs fastest. The same for cells.
constexpr std::array<int, 3> index_in(const BlockKey& key, int n, int dimension) {
  const int edge = block_edge(dimension);
  std::array<int, 3> out{};
  for (int a = dimension - 1; a >= 0; --a, n /= edge) {
    const auto k = static_cast<std::size_t>(a);
    out[k] = key.i[k] * edge + n % edge;
  }
  return out;
}

struct GridGeometry {
  int dimension = 3;
  double h = 1, inv_h = 1;
  std::array<double, 3> min{};  ///< lower domain planes [m]
  std::array<int, 3> cells{};   ///< from plane to plane
  int level = 0;
  double scale = 1, origin = 0.5;  ///< 2^l, and half of it: t of the lower plane
  /// Knot coordinate t. The same expression decides weights and ownership.
  double knots(double x, int axis) const {
    return (x - min[static_cast<std::size_t>(axis)]) * inv_h + scale - origin;
  }
  /// Storage coordinate of nodes.
  double storage(double x, int axis) const { return knots(x, axis) + 0.5; }
  double lower_storage() const { return origin + 0.5; }
  double upper_storage(int axis) const {
    return cells[static_cast<std::size_t>(axis)] + lower_storage();
  }
  /// Where a node lies [m].
  double place(int storage_index, int axis) const {
    return min[static_cast<std::size_t>(axis)] + (storage_index - lower_storage()) * h;
  }
  double upper(int axis) const {
    return min[static_cast<std::size_t>(axis)] + h * cells[static_cast<std::size_t>(axis)];
  }
  /// The planes are knots, not nodes.
  bool planes_on_knots() const { return level > 0; }
};

/// The next finer level.
GridGeometry finer(const GridGeometry& geometry);

/// The block of this level that holds a position of `dimension` coordinates.
BlockKey block_of(const GridGeometry& geometry, const double* position);

}  // namespace krater
