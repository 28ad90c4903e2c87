// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/frames.hpp
/// The only place in the step that knows what kind of frame it is in: which tensor axis each grid
/// axis is, and what symmetry about the axis adds (theory 3; per full revolution, so masses and
/// forces are those of the whole body):
///   L_tt = v_r/r,   f_r += - V sigma_tt S/r.

namespace krater {

template <int Dim>
struct Cartesian {
  static constexpr int dim = Dim;
  static constexpr bool hoop = false;
};

struct Axisymmetric {
  static constexpr int dim = 2;
  static constexpr bool hoop = true;
};

/// Tensor axis of a grid axis: (x, y, z) -> 0 1 2; (x, z) or (r, z) -> 0 2, so that out of plane or
/// hoop is 1.
template <int Dim>
constexpr int tensor_axis(int axis) {
  return Dim == 2 ? 2 * axis : axis;
}

/// Component of a symmetric tensor stored as xx yy zz yz xz xy.
constexpr int voigt(int a, int b) { return a == b ? a : 6 - a - b; }

}  // namespace krater
