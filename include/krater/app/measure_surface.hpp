// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file app/measure_surface.hpp
/// The surface of a body of points on the measuring grid of a scene, and its diameters
/// (definitions: app/measures.hpp).
#include "krater/app/measures.hpp"
#include "krater/app/volume_fraction.hpp"

namespace krater {

/// a: twice the initial spacing of the points [m].
double node_spacing(const MeasureContext& context);
bool is_closed(const MeasureContext& context, int axis, int side);
bool is_symmetry(const MeasureContext& context, int axis, int side);

/// On the nodes about the body; `to_planes`: also on those between it and the symmetry planes.
VolumeFraction volume_fraction(const BodyPoints& body, const MeasureContext& context,
                               bool to_planes = false);
/// Closed sides that are no symmetry.
VolumeFraction::Walls walls_of(const MeasureContext& context);

/// Highest (side 1) or lowest place of the surface along an axis [m].
double outermost(const BodyPoints& body, const MeasureContext& context, int axis, int side);
double extent(const BodyPoints& body, const MeasureContext& context, int axis);

/// At a height on the last axis, which may count from the body's lower end [m]; NaN: no material.
double diameter(const BodyPoints& body, const MeasureContext& context, double at, bool from_end);
double largest_diameter(const BodyPoints& body, const MeasureContext& context);

}  // namespace krater
