// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file scene/point.hpp
/// A point file as plain data (`krater point`): one material of a `materials:` block, read by the
/// scene's own reader, and the loading path that one point of it is taken through. Every value is
/// checked, in SI, with every default filled in.
///
/// Axes: x is the axis of loading, y and z are lateral; a shear displaces along x with y. Strains
/// are true (logarithmic), tension positive, as stresses are; pressure is positive in compression.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "krater/scene/scene.hpp"

namespace krater {

enum class PathKind {
  uniaxial_stress,    ///< stretch along x, no lateral stress
  uniaxial_strain,    ///< stretch along x, no lateral strain
  simple_shear,       ///< F = I + gamma e_x e_y
  triaxial,           ///< stretch along x under a lateral stress or at a triaxiality
  hydrostatic,        ///< x, y and z stretch alike, to compressions or pressures
  biaxial,            ///< x and y stretch alike under a stress along z
  velocity_gradient,  ///< L(t)
  stretch,            ///< F(t)
  hugoniot,           ///< states behind a steady shock into material at rest
  release_isentrope   ///< from such a state down to a pressure
};
const char* name(PathKind kind);

using TimeFunction = std::function<double(double)>;

struct PathOptions {
  PathKind kind = PathKind::uniaxial_stress;
  std::string where;
  /// Strain, shear, rho/rho0 - 1 or pressure [Pa] at which the path turns round or ends; from 0.
  std::vector<double> turns;
  bool by_pressure = false;  ///< hydrostatic: turns are pressures
  double rate = 0;           ///< of it [1/s], positive; release_isentrope: of the volume, nominal
  double time = 0;           ///< end [s] of velocity_gradient and stretch
  std::optional<double> lateral_stress;  ///< [Pa], tension positive; biaxial: along z
  std::optional<double> triaxiality;     ///< -p/q
  std::vector<TimeFunction> tensor;      ///< nine, row-major: L [1/s] or F
  std::vector<double> particle_speeds;   ///< [m/s] behind the shock, or ...
  std::vector<double> densities;         ///< [kg/m^3]
  double pressure = 0;                   ///< [Pa] at which a release ends
};

struct PointScene {
  std::string file, title, resolved;
  MaterialOptions material;  ///< its initial temperature is that of the path's start
  PathOptions path;
  int steps = 0;      ///< over the whole path
  int every = 1;      ///< steps between two rows of the result
  double length = 0;  ///< of the element [m]; 0: nothing asks for it
  std::vector<std::string> notes;
};

/// Read and check a point file; `overrides`: "path=value" of --set. Throws InputError (`FILE:LINE:
/// path: ...`).
PointScene read_point(const std::string& file, const std::vector<std::string>& overrides = {});

}  // namespace krater
