// SPDX-License-Identifier: GPL-3.0-or-later
// The named shapes beyond box, cylinder and sphere (primitives.hpp). Shapes with an axis are made
// with their base at the origin along +z; `placed` puts them. All throw std::invalid_argument with
// the reason.
#pragma once

#include <memory>
#include <optional>

#include "krater/geometry/solids/profile.hpp"
#include "krater/geometry/solids/solid.hpp"

namespace krater {

/// The map that takes +z to a signed coordinate axis (0 x, 1 y, 2 z) and the origin to `base`.
Affine placing(const Vector3& base, int axis, bool negative = false);

std::shared_ptr<const Solid> make_tube(double inner_radius, double outer_radius, double height);

/// Radius `base_radius` at z = 0 and `top_radius` (0: a full cone) at z = height.
std::shared_ptr<const Solid> make_cone(double base_radius, double top_radius, double height);

/// About the origin, axis z; major > minor.
std::shared_ptr<const Solid> make_torus(double major_radius, double minor_radius);

/// About the origin.
std::shared_ptr<const Solid> make_ellipsoid(const Vector3& semi_axes);

/// A cylinder of length `length` in all that ends in a tangent ogive, tip at z = length. The arc of
/// the nose has the radius crh x 2 `radius` (calibre-radius-head); the nose is
/// radius x sqrt(4 crh - 1) long; crh >= 1/2, where 1/2 is a hemisphere.
std::shared_ptr<const Solid> make_ogive(double radius, double length, double crh);

/// All points with low <= x_axis <= high; either may be infinite.
std::shared_ptr<const Solid> make_slab(int axis, double low, double high);

}  // namespace krater
