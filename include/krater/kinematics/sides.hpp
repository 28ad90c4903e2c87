// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/sides.hpp
/// Sides of the domain that act on bodies themselves and not on nodes of a grid. A wall lets
/// nothing come nearer than `standoff` to its plane: what would be carried beyond, x + dt v, gets
/// the velocity that just touches, with Coulomb friction, and is never pulled; a sticky side holds
/// it whole while it pushes. A side that drives is a wall that moves from its place at the start.
#include <array>
#include <cstddef>
#include <vector>

#include "krater/contact/options.hpp"
#include "krater/geometry/frame.hpp"

namespace krater {

struct DomainSides {
  Frame frame = Frame::cartesian_3d;
  std::array<std::array<Boundary, 2>, 3> sides{};
  std::array<std::array<double, 2>, 3> planes{};  ///< where they are [m]
};

struct PushingSide {
  std::size_t axis;
  double inwards, plane, friction;  ///< inwards: +1 or -1
  bool sticky;
  double start = plane;  ///< of the plane at time 0
  Triple velocity{};     ///< of what drives

  void set_time(double time) { plane = start + velocity[axis] * time; }
  double plane_after(double dt) const { return plane + velocity[axis] * dt; }

  /// By how much a velocity v of what is at x falls short along the normal; zero or less: none.
  double missing(const Triple& x, const Triple& v, double standoff, double dt) const {
    return inwards * ((plane_after(dt) + inwards * standoff - x[axis]) / dt - v[axis]);
  }
  /// The change of velocity of what moves at v, by `missing` along the normal.
  Triple push(const Triple& v, double missing, int dimension) const;
};

/// Walls, sticky sides and those that drive.
std::vector<PushingSide> pushing_sides(const DomainSides& domain);

}  // namespace krater
