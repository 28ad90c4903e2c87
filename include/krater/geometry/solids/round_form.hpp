// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file geometry/solids/round_form.hpp
/// Spheres, cylinders and tubes by their numbers, for meshes that follow their surfaces.
#include "krater/geometry/solids/affine.hpp"

namespace krater {

struct RoundForm {
  enum class Kind { sphere, tube } kind = Kind::sphere;
  double inner = 0, outer = 0;  ///< radii [m]; inner 0: a sphere or full cylinder
  double height = 0;            ///< of a tube, from its base on [m]
  Vector3 base{};               ///< centre of a sphere, of the face at which a tube begins [m]
  Vector3 axis{0, 0, 1};        ///< of a tube, from the base on: a unit vector

  /// The image under a map that is a similarity of scale `factor`.
  RoundForm mapped(const Affine& map, double factor) const {
    RoundForm out = *this;
    out.inner *= factor;
    out.outer *= factor;
    out.height *= factor;
    out.base = map.apply(base);
    out.axis = map.turn(axis);
    for (double& a : out.axis) a /= factor;
    return out;
  }
};

}  // namespace krater
