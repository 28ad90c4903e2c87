// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mesh/options.hpp
/// What a scene says of a body of elements.

namespace krater {

/// How the modes that one point does not see are held (kinematics/mesh/hourglass.hpp).
struct HourglassOptions {
  enum class Kind { assumed_strain, viscous } kind = Kind::assumed_strain;
  double viscous = 0.1;  ///< c_h
};

struct MeshOptions {
  double element = 0;  ///< edge [m]; a whole number of them fits along each axis of the body
  HourglassOptions hourglass;
};

}  // namespace krater
