// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file geometry/meshes/round_mesh.hpp
/// O-grids: meshes of discs, balls, cylinders and tubes whose surface nodes lie on the true
/// surface. A quarter disc of radius R has an inner block of n x n elements with bulged sides,
///   x = c u (1 + k (1 - v^2)),   y = c v (1 + k (1 - u^2)),   0 <= u, v <= 1,
/// and a ring of 2 n x m elements out to the circle, straight between them at equal angles. The
/// bulge k = 1 - sqrt(3)/2 makes the three angles at the block's corner 120 degrees. The eighth of
/// a ball has n^3 + 3 n^2 m elements,
///   x_a = c u_a (1 + k (2 - u_b^2 - u_c^2)),
/// and k = 1/10 makes the edges at the block's corner those of a regular tetrahedron. The least
/// scaled Jacobian (geometry/meshes/mesh.hpp) of discs and cylinders is 0.79 for n = 1, else 0.83
/// to sqrt(3)/2, of balls 0.68 to 0.77, 4/(3 sqrt(3)), the most that four hexahedra about a corner
/// can have. n and m make the mean element about as large as asked, edges 0.6 to 1.7 times that
/// where four elements fit on the radius. The volume is that of the facets, to leading order
/// 1 - (2/3) (pi/8n)^2 of a disc's: mass, rho0 times the mesh's volume, is smaller by as much.
#include <array>

#include "krater/geometry/meshes/mesh.hpp"
#include "krater/geometry/solids/box.hpp"
#include "krater/geometry/solids/solid.hpp"

namespace krater {

/// Which of the two halves on either side of a middle plane a mesh has.
enum class Halves { both, upper, lower };

/// The disc about the origin; `element` [m] is the size asked for, here and below.
Mesh disc_mesh(double radius, double element, const std::array<Halves, 2>& halves);
/// The annulus about the origin.
Mesh ring_mesh(double inner, double outer, double element, const std::array<Halves, 2>& halves);
/// The ball about the origin.
Mesh ball_mesh(double radius, double element, const std::array<Halves, 3>& halves);

/// The mesh of a sphere, cylinder or tube in the domain, which may cut it in planes through its
/// middle and across its axis. Throws std::invalid_argument, with the reason, for other cuts, other
/// solids and more than 5e7 elements.
Mesh round_mesh(const Solid& solid, Frame frame, const Box& domain, double element);

}  // namespace krater
