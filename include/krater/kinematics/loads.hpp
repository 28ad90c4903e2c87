// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/loads.hpp
/// Loads on the mass of bodies: an acceleration b(x, X, t), X the position at the start. On points
/// it is written to their column; a rigid body takes force and moment
///   F = sum m b,   M = sum (x - c) x m b.
#include <functional>

#include "krater/contact/rigid.hpp"
#include "krater/points/columns.hpp"
#include "krater/points/store.hpp"

namespace krater {

/// Acceleration [m/s^2] along the grid axes at x (at the start: X) and time t.
using Acceleration = std::function<Triple(const Triple& x, const Triple& X, double t)>;

/// `reference`: column of the positions at the start. Returns the force, sum m b [N].
Triple accelerate(PointStore& points, const PointColumns& columns, int reference, int dimension,
                  const Acceleration& load, double time);

/// Sets the load of a rigid body from all its points.
void load_rigid(RigidBody& body, BlockGrid& grid, const PointColumns& columns,
                const Acceleration& load, double time);

}  // namespace krater
