// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file simulation/totals.hpp
/// What a row of history asks of a set of points, by one walk over its columns that knows nothing
/// of the step: totals
///
///     sum m,  sum m v,  sum m (v.v + h^2/4 B:B)/2,  sum m e,  sum r x m v,
///     sum m s:s/(4 G (1 - phi) rho),
///
/// and where the points are. h^2/4 B:B: the affine part of the velocity about a point; elements and
/// particles have none.
#include <array>
#include <limits>

#include "krater/geometry/frame.hpp"

namespace krater {

struct Totals {
  double count = 0, mass = 0, kinetic = 0, internal = 0;
  std::array<double, 3> momentum{};
  double angular_momentum =
      0;  ///< about the origin, out of plane in 2D frames, about z in 3d; affine part included
  double deviatoric = 0;  ///< elastic energy of the deviator [J]

  Totals& operator+=(const Totals& other);
};

/// Of material points only: others are few, and measures of them look at their elements.
struct PointBounds {
  static constexpr double kNowhere = std::numeric_limits<double>::infinity();
  Triple low{kNowhere, kNowhere, kNowhere}, high{-kNowhere, -kNowhere, -kNowhere};  ///< [m]
  double greatest_volume = 0;  ///< of a point [m^3], as field::Mass over density
};

struct PointSurvey {
  Totals totals;
  PointBounds bounds;
};

}  // namespace krater
