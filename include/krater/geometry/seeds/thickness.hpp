// SPDX-License-Identifier: GPL-3.0-or-later
// How thick a body is where its points are: at a point, the shortest of the chords through it along
// the grid's axes. Corners and rims of a stout body are thin too, so a share of the mass goes with
// the figure: a fifth of a ball's mass lies where it is thinner than 0.44 diameters, all of a
// plate's where it is as thin as the plate. Oblique walls count thicker than they are, by at most
// sqrt 3.
#pragma once

#include <array>
#include <vector>

#include "krater/geometry/seeds/lattice.hpp"

namespace krater {

/// Sides of the domain that mirror: a chord that ends there goes on behind, one that ends at two
/// has no end. [axis][0 lower, 1 upper].
using MirrorSides = std::array<std::array<bool, 2>, 3>;

/// The thickness (m) below which `share` of the measure of the points lies, from at most 2000 of
/// them evenly taken; 0 if there are none.
double thickness_of_share(const Solid& solid, Frame frame, const std::vector<SeedPoint>& points,
                          const Box& domain, const MirrorSides& mirrors, double share);

}  // namespace krater
