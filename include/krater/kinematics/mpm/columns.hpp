// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/columns.hpp
/// The columns that material points over a grid need, beside those of their material. They are
/// declared before and after the stages of the material are made: some depend on what those ask
/// for. A field is named here, and nowhere else by this method.
#include "krater/kinematics/mpm/node_loads.hpp"
#include "krater/kinematics/mpm/options.hpp"
#include "krater/points/columns.hpp"

namespace krater {

/// What a scene asks of the points of a body.
struct PointNeeds {
  double density = 0;               ///< at the start [kg/m^3]
  bool loaded = false;              ///< a body force acts
  bool face_loads = false;          ///< its faces are loaded
  bool walls = false;               ///< some side is a unilateral wall
  bool reference_position = false;  ///< asked for by output
  bool deformation = false;         ///< F asked for by output
  bool domain = false;              ///< its tensor, by whatever shape
};

void declare_points(const MethodOptions& method, const PointNeeds& needs, Layout& layout);
/// After the stages of the material. `heat_floor`: the ledger may owe heat; `fluid`: the pressure
/// is integrated on the grid.
void declare_results(bool heat_floor, bool fluid, Layout& layout);
/// Of a rigid body: what the scatter and the motion as a whole need; no stress, no law.
void declare_rigid_points(const MethodOptions& method, double density, Layout& layout);

/// Where the columns lie. `removes`: failed points leave the computation.
LoadColumns load_columns(const Layout& layout);
PointColumns point_columns(const Layout& layout, bool removes);

}  // namespace krater
