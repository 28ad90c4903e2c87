// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file contact/joint_profile.hpp
/// Where the face of a body lies, from its filling at three nodes along a grid axis
/// (contact/contact.hpp).
#include <algorithm>
#include <cmath>

namespace krater {

/// Filling of one body at the node before the joint, at it and beyond, from its inside out.
struct JointProfile {
  double before, at, beyond;

  /// A body ends along an axis when it fills the node beyond at most half as well as the node
  /// before: faces up to 70 degrees off do.
  bool ends() const { return beyond < 0.5 * before; }
  /// How far the body reaches beyond the joint's node [cells].
  double reach() const {
    // A face at a: the share of the bend in the drop is a/1.6 within 0.02 for |a| < 1/2,
    // whatever part of the node's width the body takes.
    const double bend = (at - 0.5 * (before + beyond)) / (before - beyond);
    // A body that thins out behind its face bends as if it reached further. The tail beyond the
    // face, ~ (a + 1/2)^3, knows better; 0.02 is what a lattice of two points per cell may miss.
    const double tail = std::cbrt(beyond / at + 0.02);
    return std::min(1.6 * bend, 1.73 * tail - 0.55);
  }
};

}  // namespace krater
