// SPDX-License-Identifier: GPL-3.0-or-later
// A grid for tests of points that are split, cut and merged.
#pragma once

#include "krater/grid/geometry.hpp"

namespace krater::test {

/// 32 cells along each axis, of edge h.
inline GridGeometry cells_of(int dimension, double h) {
  GridGeometry g;
  g.dimension = dimension;
  g.h = h;
  g.inv_h = 1 / h;
  g.cells = {32, 32, dimension == 3 ? 32 : 0};
  return g;
}

}  // namespace krater::test
