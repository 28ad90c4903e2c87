// SPDX-License-Identifier: GPL-3.0-or-later
// Made-up sets of points with known answers: regions filled with a lattice, each point carrying the
// part of its cell that lies in the region.
#pragma once

#include <functional>

#include "krater/measure/measures.hpp"

namespace krater::test {

/// Domain from min to max; the axis r = 0 is a symmetry.
MeasureContext measuring_domain(Frame frame, double cell, Triple min, Triple max);

/// Two points per cell and direction where `inside`, density 1000; masses of the full revolution.
/// `density` of the points is that of the whole cell's material: volume = mass / density.
BodyPoints lattice_points(const MeasureContext& context, Triple low, Triple high,
                          const std::function<bool(const Triple&)>& inside, int body = 0);

/// Both, one after the other.
BodyPoints together(BodyPoints a, const BodyPoints& b);

}  // namespace krater::test
