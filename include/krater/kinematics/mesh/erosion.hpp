// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mesh/erosion.hpp
/// Elements that are taken out, at the end of a step, when one of these holds:
///   failed                     its material has failed
///   eps_p >= plastic_strain    (SPEAR takes 1)
///   V/V_0 outside volume_ratio
///   min_I J_I/mean J <= jacobian, or its step at CFL 1 below `step`: it has collapsed.
/// Its internal and hourglass energy leave the account as removed. Its mass and momentum stay on
/// its nodes: a crater keeps pushing. A node without elements is a point of mass that flies on, and
/// meets other bodies; heat that it gets, and the share of eroded elements in the heat of a node,
/// has no matter to go to and is removed too. Faces that lay on an eroded element are exposed from
/// the next step on.
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "krater/kinematics/mesh/mesh.hpp"

namespace krater {

/// What was beside what at the start, by the numbers that elements had then.
struct ElementNeighbours {
  std::vector<std::int32_t> beside;  ///< per element and face (element_faces()); -1: nothing
  std::vector<std::int32_t> corners;
  std::vector<double> shares;  ///< masses of the corners [kg]
  std::vector<bool> alive;
};
ElementNeighbours find_neighbours(const Mesh& mesh);

/// Why elements were taken out, so far.
struct Eroded {
  double failed = 0, plastic_strain = 0, volume_ratio = 0, jacobian = 0, step = 0;  ///< elements
  double all() const { return failed + plastic_strain + volume_ratio + jacobian + step; }
  static const std::array<double Eroded::*, 5> parts;
  static constexpr std::array<const char*, 5> names{"failed", "plastic_strain", "volume_ratio",
                                                    "jacobian", "step"};
};
/// "12 elements were eroded, as the scene asks: 10 by plastic_strain, 2 by step".
std::string describe_eroded(const Eroded& eroded);

inline constexpr std::array<double Eroded::*, 5> Eroded::parts{
    &Eroded::failed, &Eroded::plastic_strain, &Eroded::volume_ratio, &Eroded::jacobian,
    &Eroded::step};

}  // namespace krater
