// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/load_options.hpp
/// What drives a scene beside velocities and body forces: pressure, traction or velocity on faces
/// of bodies, and damping.
#include <array>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace krater {

using TimeFunction = std::function<double(double)>;  ///< of the time [s], SI

/// Load on the surface of bodies where it lay at the start; it moves with the material.
struct FaceLoad {
  enum class Kind { pressure, traction, velocity };
  std::string name, where;
  std::vector<int> bodies;
  int axis = -1, side = -1;  ///< the face whose outward normal is this grid axis; -1: all around
  /// [grid axis][0 lower, 1 upper] bounds of the position at the start [m].
  std::array<std::array<double, 2>, 3> region = {unbounded, unbounded, unbounded};
  std::function<bool(const std::array<double, 3>&)> inside;  ///< and then there; empty: anywhere
  Kind kind = Kind::pressure;
  /// Pressure [Pa] alone, or components along the grid axes; empty: none, or not prescribed.
  std::array<TimeFunction, 3> value;

  static constexpr std::array<double, 2> unbounded{-std::numeric_limits<double>::infinity(),
                                                   std::numeric_limits<double>::infinity()};
};

struct LoadOptions {
  double damping = 0;  ///< eta of f = -eta m v [1/s]
  std::vector<FaceLoad> faces;
  bool any() const { return damping > 0 || !faces.empty(); }
};

}  // namespace krater
