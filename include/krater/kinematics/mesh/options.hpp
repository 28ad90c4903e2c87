// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mesh/options.hpp
/// What a scene says of a body of elements.
#include <array>
#include <limits>

#include <memory>

namespace krater {

struct Mesh;

/// How the modes that one point does not see are held (kinematics/mesh/hourglass.hpp).
struct HourglassOptions {
  enum class Kind { assumed_strain, stiffness, viscous } kind = Kind::assumed_strain;
  double viscous = 0.1;     ///< c_h
  double stiffness = 0.05;  ///< kappa
};

/// When an element is taken out (kinematics/mesh/erosion.hpp), or becomes points (conversion.hpp):
/// any of these.
struct ErosionOptions {
  bool failed = false;  ///< by the damage or spall of its material
  double plastic_strain = std::numeric_limits<double>::infinity();
  std::array<double, 2> volume_ratio{0, std::numeric_limits<double>::infinity()};  ///< rho_0/rho
  double jacobian = -std::numeric_limits<double>::infinity();  ///< least of its corners by the mean
  double step = 0;                                             ///< it allows at CFL 1 [s]
  bool any() const {
    return failed || plastic_strain < std::numeric_limits<double>::infinity() ||
           volume_ratio[0] > 0 || volume_ratio[1] < std::numeric_limits<double>::infinity() ||
           jacobian > -std::numeric_limits<double>::infinity() || step > 0;
  }
};

/// What frames call the points that a body's elements became: NAME_points.
inline constexpr const char* kPointsOf = "_points";

/// Where gradients are taken (kinematics/mesh/placed_element.hpp).
/// Adaptive ones begin as initial ones, and are taken anew, element by element.
enum class ElementReference { current, initial, adaptive };

struct MeshOptions {
  double element = 0;  ///< edge [m]: a whole number of them fits along each axis of a block
  std::shared_ptr<const Mesh> mesh;  ///< of what is no block; null: a block
  HourglassOptions hourglass;
  ElementReference reference = ElementReference::current;
  double refresh_strain = 0.3;  ///< adaptive: greatest Green-Lagrange strain on one reference
  ErosionOptions erosion;
  bool converts = false;  ///< what erosion takes out becomes points
};

}  // namespace krater
