// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file measure/mesh_surface.hpp
/// The surface of a body of elements: straight edges between its nodes, known exactly.
#include "krater/measure/measures.hpp"

namespace krater {

/// Lowest and highest place along an axis [m].
std::array<double, 2> mesh_ends(const BodyPoints& body, int axis);

/// The section at z0 of the last axis: the widest of its edges there, from the axis or plane of
/// symmetry that cuts the body (`middle`, by axis), else from side to side [m]; NaN: no material.
double mesh_diameter(const BodyPoints& body, Frame frame,
                     const std::array<std::optional<double>, 2>& middle, double z0);

/// Heights at which the width of a body of straight edges can be greatest, between `low` and
/// `high`.
std::vector<double> mesh_heights(const BodyPoints& body, int axis, double low, double high);

}  // namespace krater
