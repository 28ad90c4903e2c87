// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file points/place.hpp
/// One point among others, read component by component.
#include "krater/points/layout.hpp"

namespace krater {

/// Where a point is, and its components by slot.
struct PointPlace {
  const double* point;
  double operator()(int slot) const { return point[kLanes * slot]; }
};
/// s:s of the deviator from slot `s` on.
inline double squared_deviator(PointPlace at, int s) {
  double square = 0;
  for (int k = 0; k < 6; ++k) square += (k < 3 ? 1 : 2) * at(s + k) * at(s + k);
  return square;
}

}  // namespace krater
