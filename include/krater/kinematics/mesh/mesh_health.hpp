// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mesh/mesh_health.hpp
/// What a mesh says of itself:
///   j = det [edges that leave a corner]   of every corner, over the mean of the element's corners:
/// 1 in a parallelepiped; below zero the element is folded there. One-point elements feel their
/// mean volume only and run on folded, so it is counted and not a fault. And how much of the
/// internal energy holds hourglass modes, in all and element by element: beyond a tenth the answer
/// is that of the hourglass control (the common rule of finite-element codes).
#include <cstddef>
#include <span>

#include "krater/contact/options.hpp"

namespace krater {

struct MeshHealth {
  std::size_t elements = 0;
  std::size_t folded = 0;   ///< with a corner turned inside out
  double least_corner = 1;  ///< least j
  int worst_body = -1;      ///< where that is
  std::size_t worst_element = 0;
  double hourglass = 0;  ///< energy that holds hourglass modes, part of `internal` [J]
  double internal = 0;   ///< [J]
  std::size_t held = 0;  ///< elements more than half of whose energy it is

  double hourglass_share() const { return internal > 0 ? hourglass / internal : 0; }
};

/// Where bodies fill space twice: an element's own neighbours do not see one that comes from
/// elsewhere, for a body has no contact with itself. At nodes i of cells of edge h
///   phi_i = h^-dim sum_e int_e N_i dV,   N_i the hat functions,
/// is 1 inside a body however its elements are shaped, and 2 where it lies on itself.
struct MeshOverlap {
  std::size_t nodes = 0;  ///< with phi > 1.2
  double most = 0;        ///< greatest phi
  int body = -1;          ///< there
  Triple place{};         ///< [m]
};

/// Least j of an element with these corners, in two dimensions by the first two axes.
double least_corner(int dimension, std::span<const Triple> corners);

}  // namespace krater
