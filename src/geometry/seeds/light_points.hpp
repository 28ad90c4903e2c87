// SPDX-License-Identifier: GPL-3.0-or-later
// No seed far lighter than its neighbours: at a tip, an edge or the sliver of a cut a point of
// almost no mass would be left, which meets the forces of full ones.
#pragma once

#include <cstddef>
#include <vector>

#include "krater/geometry/seeds/lattice.hpp"

namespace krater {

/// The widest of the spacings along the grid's axes, m.
double widest_spacing(const LatticeOptions& options, Frame frame);

/// Share of a whole lattice point: of its volume, in the axisymmetric frame of the ring's there, in
/// the column at the axis of that column's.
double fullness(const SeedPoint& point, Frame frame, const LatticeOptions& options);

/// How far a light point looks for one that takes it, in spacings.
inline constexpr double light_reach = 3;

/// Points less than a quarter as full as the body's typical point (the median by mass, so that a
/// body thinner than a spacing keeps its points) are given, lightest first, to the nearest heavier
/// one within `reach` (m), mere traces to the nearest anywhere; equally near ones share, which
/// keeps symmetric bodies symmetric. Measure and centroid (r: of the area, lattice.hpp) are kept
/// exactly, unless the centroid lies outside of the solid: then the point that takes stays where it
/// is. `full[n]`: fullness of points[n]. Returns how many were given away.
std::size_t give_light_points(std::vector<SeedPoint>& points, std::vector<double> full,
                              const Solid& solid, Frame frame, double reach);

}  // namespace krater
