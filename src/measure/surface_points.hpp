// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file measure/surface_points.hpp
/// What surfaces and diameters of points share (definitions: measure/measures.hpp).
#include <array>

#include "krater/measure/measures.hpp"
#include "krater/measure/volume_fraction.hpp"

namespace krater {

/// Least and greatest coordinate of the points [m].
std::array<double, 2> range(const BodyPoints& body, int axis);

/// A_p at distance r from the axis for a share of the full revolution [m^2]. A point on the axis
/// itself stands for radii up to its own size, so r is bounded below.
double section(double volume, double r, double share, double a);

/// Over the points, and up to symmetry planes where `to_planes`.
MeasuringAxis body_axis(const BodyPoints& body, const MeasureContext& context, int d,
                        bool to_planes = false);

/// Places, masses and densities of the points from `low` to `high` along an axis, into `out`.
void copy_points_between(const BodyPoints& body, int axis, double low, double high,
                         BodyPoints& out);

/// The same where they are to be had: from the source of `body`, or in `own`.
const BodyPoints& layer_of(const BodyPoints& body, int axis, double low, double high,
                           BodyPoints& own);
/// All points, gathered or not.
const BodyPoints& all_of(const BodyPoints& body);

/// Where the points are, and the sparse ones of them.
SurfaceMemo::Bounds bounds_of(const BodyPoints& body, const MeasureContext& context);
/// The most that a point at least `r` from the axis can fill (filled_volume) [m^3].
double most_filled(const MeasureContext& context, double r);

/// Lowest and highest place of the surface along an axis: as far as sparse points, in the domain,
/// within a of the points. Not a number stays so [m].
std::array<double, 2> surface_ends(const BodyPoints& body, const MeasureContext& context, int axis);

}  // namespace krater
