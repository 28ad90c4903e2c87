// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/options.hpp
/// What a scene may choose about the method; reasons of the defaults: src/README.md (decisions).
namespace krater {

enum class Shape { quadratic_bspline, gimp, linear };
enum class Transfer { tflip, flip, apic, xpic };
enum class Update { usl, musl, usf };
enum class Reference { current, initial, adaptive };
/// Watched: simulation/torn_points.hpp; points split against it: kinematics/mpm/stretch.hpp.
enum class NumericalFracture { ignore, watch, split };
enum class GridPressure { fluids, none, all };  ///< bodies of mpm/grid_pressure.hpp

struct MethodOptions {
  Shape shape = Shape::quadratic_bspline;
  Transfer transfer = Transfer::tflip;
  int xpic_order = 2;  ///< xpic only
  Update update = Update::usl;
  int points_per_direction = 2;
  bool stagger = true;
  double jitter = 0;  ///< fraction of the point spacing
  unsigned seed = 1;
  bool cell_averaging = true;  ///< theory 18
  GridPressure grid_pressure = GridPressure::fluids;
  double flip_fraction = 0.99;               ///< TFLIP alpha
  double energy_alpha = 0.5;                 ///< Algorithm 1: share of the pressure of the start
  bool dormant_blocks = true;                ///< skip what is at rest (the bits are the same)
  Reference reference = Reference::current;  ///< configuration of the weights (theory 3)
  NumericalFracture numerical_fracture = NumericalFracture::ignore;
  double refresh_strain = 0.3;  ///< adaptive: largest Green-Lagrange strain before a new reference
};

}  // namespace krater
