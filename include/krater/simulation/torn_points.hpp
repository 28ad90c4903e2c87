// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file simulation/torn_points.hpp
/// Numerical fracture (method.numerical_fracture: watch): sound material that parts because its
/// points have lost each other on the grid, and for no reason of its own.
///
/// Two points share a node while they are less than 2R - h apart along every grid axis, R half the
/// support of the shape function: h (linear), h + l_p (gimp), 3/2 h (quadratic B-spline). Points of
/// a lattice lie as far apart as their domains are long (kinematics/mpm/domain.hpp), so with l_b
/// the components of the longest axis
///   stretch = max over b of |l_b| / (2R - h)_b
/// above 1 says that a point no longer meets those that were next to it: at a pull of 2, 3 and 4 by
/// two points to a cell for linear, uniform gimp and quadratic functions (Homel et al. 2016 on such
/// fracture). It is torn when none has taken their place either: on one of its two sides along the
/// longest axis, further than a quarter of it or of the reach, there is no point of the body
/// that shares a node, nor its own image in a plane that mirrors. So shear tears nothing, though it
/// stretches: neighbours change. A point at a free end of its body counts once it is so stretched.
///
/// Only sound points of what can lose a tension: not failed ones, not those of fluids. Looked for
/// at rows of the history and at frames. Off, no domain is kept and nothing is asked.
#include <cstddef>
#include <vector>

#include "krater/geometry/frame.hpp"

namespace krater {

class Body;
class Simulation;

struct TornPoints {
  std::size_t stretched = 0;    ///< points of a stretch above 1
  std::size_t torn = 0;         ///< ... that have lost a side
  double torn_mass = 0;         ///< [kg]
  double greatest_stretch = 0;  ///< over the reach of the grid
  std::vector<std::size_t> torn_by_body;
};

/// A body of material points that resists being pulled: with a strength, however soft. Rubber does,
/// whose pressure is integrated as that of a fluid (Body::is_fluid).
bool may_tear(const Body& body);

/// Stretch of every point of a body over the reach of its nodes, those torn above 0; by id.
struct FractureOfPoints {
  std::vector<double> stretch;  ///< 0 where no tension is borne
  std::vector<bool> torn;
};

/// Bodies of material points only: others are all 0. The scene watches.
FractureOfPoints fracture_of(const Simulation& sim, int body);
TornPoints look_for_torn_points(const Simulation& sim);

}  // namespace krater
