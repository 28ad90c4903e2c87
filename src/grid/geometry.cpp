// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/grid/geometry.hpp"

namespace krater {

GridGeometry finer(const GridGeometry& geometry) {
  GridGeometry out = geometry;
  out.h *= 0.5;
  out.inv_h *= 2;
  for (int& cells : out.cells) cells *= 2;
  out.level += 1;
  out.scale *= 2;
  out.origin *= 2;
  return out;
}

BlockKey block_of(const GridGeometry& geometry, const double* position) {
  BlockKey key;
  key.level = geometry.level;
  for (int a = 0; a < geometry.dimension; ++a)
    key.i[static_cast<std::size_t>(a)] =
        floor_div(static_cast<int>(Support::base(geometry.knots(position[a], a))),
                  block_edge(geometry.dimension));
  return key;
}

}  // namespace krater
