// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/reference.hpp
/// What a fixed reference configuration (mpm/configuration.hpp) needs outside the kernels.
///
/// A new reference (theory 3): x_a <- x, F <- I, L <- L F^-1; mass, momentum, density, stress and
/// energy untouched. The affine part of the kinetic energy changes with its lever; the change is
/// handed back.
///
/// Walls. On a fixed reference the nodes are not where the material is, so a wall acts on points in
/// their current positions: a point whose surface, half a spacing from its centre as F stretches
/// it, would pass the plane is given the impulse that stops it there,
///   b_n = max(0, v* - v_n)/dt,  v* = -gap/dt before the plane, kReturn |gap|/dt behind it,
///   |b_t| = min(mu b_n, |v_t|/dt),
/// an inelastic unilateral contact with Coulomb friction, entered as a body force.
#include "krater/contact/boundary.hpp"
#include "krater/kinematics/mpm/kernels.hpp"
#include "krater/kinematics/mpm/migrate.hpp"

namespace krater {

/// Largest Green-Lagrange strain component of a body since its reference, as the last gather saw
/// it.
double largest_strain(const BlockGrid& grid, int body);

/// Take the current configuration of a body as reference. Returns what left through open sides;
/// `heat`: lost by the affine part, and given to the points as internal energy [J]. Relink
/// afterwards.
Removed renew_reference(BlockGrid& grid, int body, const BoundarySet& boundary,
                        const PointColumns& columns, const Distribution* ranks, double& heat);

/// Add the accelerations of all walls to the points' body forces. `spacing`: of the points on the
/// reference [m]. Returns the impulse per unit of time [N].
std::array<double, 3> push_from_walls(BlockGrid& grid, const std::vector<BodyKernelData>& bodies,
                                      const BoundarySet& boundary, double spacing, double dt);

}  // namespace krater
