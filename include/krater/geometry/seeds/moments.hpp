// SPDX-License-Identifier: GPL-3.0-or-later
// Volume, first and second moments of a solid, and the centroid and inertia that follow.
#pragma once

#include <array>

#include "krater/geometry/seeds/line.hpp"
#include "krater/geometry/solids/affine.hpp"

namespace krater {

struct VolumeMoments {
  double volume = 0;               ///< int dV, m^3
  Vector3 first{};                 ///< int x_i dV, m^4
  std::array<double, 6> second{};  ///< int x_i x_j dV: xx yy zz yz xz xy, m^5

  VolumeMoments& operator+=(const VolumeMoments& other);
  Vector3 centroid() const;
  /// Per unit density, about the centroid: I_xx = int (y^2 + z^2) dV, I_yz = -int y z dV; m^5.
  std::array<double, 6> inertia() const;
  VolumeMoments mapped(const Affine& map) const;
};

/// Of a point or ring of content `volume` at `x` is volume * (1, x, x x); this adds it.
void add_point(VolumeMoments& sum, double volume, const Vector3& x);

/// Of a tetrahedron with one corner at the origin, signed like det[a b c].
VolumeMoments tetrahedron_moments(const Vector3& a, const Vector3& b, const Vector3& c);

}  // namespace krater
