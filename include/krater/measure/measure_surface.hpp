// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file measure/measure_surface.hpp
/// The surface of a body of points on the measuring grid of a scene, and its diameters
/// (definitions: measure/measures.hpp).
#include <optional>

#include "krater/measure/measures.hpp"
#include "krater/measure/volume_fraction.hpp"

namespace krater {

/// a: twice the initial spacing of the points [m].
double node_spacing(const MeasureContext& context);
bool is_closed(const MeasureContext& context, int axis, int side);
bool is_symmetry(const MeasureContext& context, int axis, int side);
/// The side on which a symmetry plane cuts the body, if any.
std::optional<int> cut_side(const BodyPoints& body, const MeasureContext& context, int axis);

/// What a point fills of its volume: no more than a cell of the measuring grid [m^3]. Beyond that
/// its neighbours are cells away, and where its volume lies is not known: the point of a gas that
/// has expanded a thousand times fills its surroundings, not the domain.
double filled_volume(const BodyPoints& body, const MeasureContext& context, std::size_t p);

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
/// Over the heights up to `within` from the lower end; 0: all.
double largest_diameter(const BodyPoints& body, const MeasureContext& context, double within);

/// Layers of two cells (2 a) at the surface that fill less of their points' volume are rarefied.
inline constexpr double kRarefied = 0.5;
/// Whether the layer of points at the place that a measure of a surface found is so thin that the
/// place says little: over half of its volume belongs to points that stand for more than a cell of
/// the measuring grid each. Craters and holes seen along z: over the whole body.
bool rarefied(const MeasureOptions& measure, const BodyPoints& body, const MeasureContext& context);

}  // namespace krater
