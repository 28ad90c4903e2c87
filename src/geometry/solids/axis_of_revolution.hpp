// SPDX-License-Identifier: GPL-3.0-or-later
// Do two lines coincide, to the round-off that a few maps leave? `size`: a length of the solid.
#pragma once

#include <cmath>

#include "krater/geometry/seeds/line.hpp"
#include "krater/geometry/solids/affine.hpp"

namespace krater {

inline bool same_line(const Line& a, const Line& b, double size) {
  constexpr double round_off = 1e-12;
  const double aa = dot(a.direction, a.direction), bb = dot(b.direction, b.direction);
  const Vector3 turn = cross(a.direction, b.direction);
  const Vector3 away = cross(a.direction, minus(b.origin, a.origin));
  return dot(turn, turn) <= round_off * round_off * aa * bb &&
         dot(away, away) <= round_off * round_off * aa * size * size;
}

}  // namespace krater
