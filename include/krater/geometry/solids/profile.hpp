// SPDX-License-Identifier: GPL-3.0-or-later
// Solids swept from a plane profile: revolved about z, or extruded along z. A profile is a closed
// curve of straight edges and circular arcs.
//
// Spans on a line: all parameters at which the line meets the surfaces of the edges, continued
// where that is simpler, cut it into pieces; each piece is in or out with its middle. Extra cuts do
// no harm, so ends of edges need no care. The surface of an arc revolved about z is part of a
// torus, (sqrt(x^2 + y^2) - r_c)^2 + (z - z_c)^2 = R^2: a quartic, solved by bracketing between the
// roots of its derivatives. Moments are line integrals along the profile (Green), by Gauss
// quadrature exact for edges and to round-off for arcs.
#pragma once

#include <memory>
#include <vector>

#include "krater/geometry/solids/solid.hpp"

namespace krater {

/// From (u0, v0) to (u1, v1): straight, or along an arc about (u_centre, v_centre) from angle
/// `start` on by `sweep` (rad; positive: anticlockwise).
struct ProfileEdge {
  double u0 = 0, v0 = 0, u1 = 0, v1 = 0;
  bool arc = false;
  double u_centre = 0, v_centre = 0, radius = 0, start = 0, sweep = 0;

  static ProfileEdge straight(double u0, double v0, double u1, double v1);
  static ProfileEdge circular(double u_centre, double v_centre, double radius, double start,
                              double sweep);
};

using Profile = std::vector<ProfileEdge>;

/// Straight edges through the corners, closed. Throws std::invalid_argument for fewer than 3
/// corners, repeated ones, no area or edges that cross or touch.
Profile polygon_profile(const std::vector<std::array<double, 2>>& corners);

/// Profile (u, v) = (r, z), r >= 0, revolved about the z axis. Throws std::invalid_argument for an
/// open profile or r < 0.
std::shared_ptr<const Solid> make_revolution(Profile profile);

/// Profile of straight edges (u, v) = (x, y), extruded over 0 <= z <= height.
std::shared_ptr<const Solid> make_extrusion(Profile profile, double height);

}  // namespace krater
