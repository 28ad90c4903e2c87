// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file contact/face_plane.hpp
/// The plane that a body's face is near a node, from the fillings of nodes (contact/contact.hpp).
///
/// The filling of a half space n.x < c (cells) at a node x is the probability that n.u < c - n.x,
/// where u is distributed along each axis as the shape function is: a sum of uniform numbers, near
/// to normal. Its variance is the same in every direction, so a filling alone tells the distance:
///   s(phi) = sigma (z + kappa/24 (z^3 - 3 z)),  z = probit(phi),  kappa = kappa_1 sum n_a^4
/// (Cornish & Fisher 1938; sigma and the excess kurtosis kappa_1 along an axis), and distances are
/// linear in x:
///   s_i = c - n.x_i   least squares over a window, weights 4 phi (1 - phi),
/// which finds every plane to 7e-4 rad. Central differences of phi smoothed by (1 2 1)/4 err by
/// 0.026 rad at 20 degrees to an axis, whatever the cell: along an axis the difference is as wide
/// as two cells, across it as the weights.
/// The points of a lattice of half a cell are lumps, whose sums are those of the half space with
/// the lumps' own width less: sigma^2 = 1/4 - 1/48 (quadratic B-spline).
///
/// Trust. Where the face is no plane - corners, thin bodies, strong curvature - the distances miss
/// it: with q the root mean square of what they miss, the slope forced to 1, in cells,
///   trust = 1/(1 + (q/0.05)^4).
/// A lattice leaves q = 0.01, a sphere of 20 cells radius 0.02 to 0.05, a corner within two cells
/// 0.1 and more.
#include <array>

namespace krater {

/// Distribution of a shape function along an axis, less that of a lump of half a cell.
struct ShapeSpread {
  double deviation;  ///< sigma [cells]
  double excess;     ///< kurtosis, less that of the normal distribution
};
/// By cumulants: a uniform number of width w has w^2/12 and -w^4/120.
ShapeSpread shape_spread(bool linear);

/// Nodes about a middle one, on a grid of any strides.
struct FillingWindow {
  const double* middle;
  std::array<int, 3> stride;
  int dimension;
};

struct FacePlane {
  std::array<double, 3> normal{};  ///< out of the body, of length 1
  double reach = 0;                ///< of the body beyond the middle, along the normal [cells]
  double trust = 0;                ///< 0 to 1
};

/// Inverse of the normal distribution for p within (0, 1), to 1e-6 (Wichura 1988, AS 241).
double probit(double p);

/// Central differences, smoothed across by (1 2 1)/4 along each other axis; in units of 1/cell.
std::array<double, 3> filling_gradient(const FillingWindow& window);

/// `guess`: about the unit normal, from which kappa is taken. `radius`: of the window [cells].
FacePlane fit_face(const FillingWindow& window, const std::array<double, 3>& guess, int radius,
                   const ShapeSpread& spread);

}  // namespace krater
