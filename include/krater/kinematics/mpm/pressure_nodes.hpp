// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/pressure_nodes.hpp
/// The second record of a node that holds fluid (mpm/grid_pressure.hpp), as long as the first.

namespace krater {

inline constexpr int kNodePressure = 0;  ///< sum S V (p + q), then the mean P [Pa]
inline constexpr int kNodeVolume = 1;    ///< sum S V of the fluids [m^3]
inline constexpr int kNodeShare = 2;     ///< their share of what fills the node
inline constexpr int kNodeReach = 2;     ///< before P is known: kNodeFill, without limit at ghosts
                                         ///< that are folded, which move with their mirror image
inline constexpr int kNodeOwn = 3;       ///< before P is known: volume of the field [m^3]
inline constexpr int kNodeDilatation = 3;  ///< D - T [m^3/s], then over the volume [1/s]
inline constexpr int kNodeWorkRate = 4;    ///< the same with the mean velocity of the step
inline constexpr int kNodeForce = 4;       ///< 4 to 6 [N], before that
inline constexpr int kNodeFill = 7;        ///< volume of all fields [m^3]

/// The sweeps over the points of a patch.
enum class PressurePart : int { collect, force, dilatation };

}  // namespace krater
