// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mesh/conversion.hpp
/// Elements that become material points of their body, in place of being taken out (erosion.hpp).
/// Along an axis of the element n = ceil(L/0.6 h) parts, 1 to 4, L its longest edge along it; of
/// part p, by the masses m_I of the element's corners,
///   w_pI = int_p N_I dV / int N_I dV at the start, sum_p w_pI = 1,     m_p = sum_I w_pI m_I,
///   x_p = sum_I w_pI m_I x_I/m_p,    v_p = sum_I w_pI m_I v_I/m_p,
///   C_p = s 4/(h^2 m_p) sum_I w_pI m_I (v_I - v_p) (x) (x_I - x_p):
/// mass, momentum, centre of mass and angular momentum are those of the corners exactly, h^2/4
/// being what the grid takes for a point's second moment. With the velocity gradient itself for C
/// the last would not be so, as the masses of an element stand at its corners. s = 1, but for
/// elements larger than about 1.15 cells: there s is such that a part's C has no more energy than
/// its corners had about v_p, and angular momentum falls short. In axial symmetry r_p is that of
/// the part's middle, as of any point (geometry/seeds/lattice.hpp).
/// The state is copied. What the points' motion has not of the corners' kinetic energy, and the
/// energy of the hourglass, is heat of the points. The corners' masses leave the nodes; a node
/// without elements has none and is no longer there. Points touch the elements that are left by
/// contact: no tension, no shear but friction.
#include <optional>
#include <string>
#include <vector>

#include "krater/points/columns.hpp"

namespace krater {

struct Eroded;

/// What the points of a body of elements are; their records are those of its elements.
struct PointsOfElements {
  PointColumns columns;
  int reference_position = -1;
  double cell = 0;    ///< h [m]
  double moment = 0;  ///< of a point, h^2/4 [m^2]
};

/// Points of a body, whole records one after the other, as stride/8 doubles.
struct ConvertedPoints {
  int body = -1;
  std::vector<double> records;
  double heat = 0;          ///< of their motion [J]
  bool barotropic = false;  ///< their pressure does not know it
};

/// The number of a point made of element `element` of `elements` at the start.
constexpr int kPartsOfElement = 64;
constexpr double number_of_part(double elements, double element, std::size_t part) {
  return elements + kPartsOfElement * element + static_cast<double>(part);
}

/// "12 elements became points, as the scene asks: 10 by plastic_strain, 2 by step".
std::string describe_converted(const Eroded& converted);

}  // namespace krater
