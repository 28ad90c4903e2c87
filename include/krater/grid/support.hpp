// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file grid/support.hpp
/// What the shape functions of a family have in common: how many nodes they reach, where these
/// begin, and D of the affine part, whose kinetic energy is 1/2 m D L : L. A wider family (cubic
/// splines: four nodes, D = h^2/3) would stand here beside this one.
#include <cmath>

namespace krater {

/// Hats of the grid convolved with a box of at most one cell (grid/shape.hpp).
struct ThreeNodes {
  static constexpr int support = 3;  ///< nodes along an axis
  /// D/h^2: sum S d^2 of the quadratic B-spline; for the others a definition, used alike on both
  /// sides of every balance.
  static constexpr double moment = 0.25;
  /// Storage index of the first node from the knot coordinate (GridGeometry::knots): the span
  /// between knots, which is the cell that averages.
  template <class Real>
  static Real base(Real t) {
    using std::floor;
    return floor(t);
  }
};

/// The family of all shapes so far: sizes of tiles follow from it.
using Support = ThreeNodes;

}  // namespace krater
