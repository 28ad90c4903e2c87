// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file step/options.hpp
/// What a scene may choose about the method; reasons of the defaults: src/README.md (decisions).
#include <array>
#include <string>
#include <vector>

namespace krater {

using Triple = std::array<double, 3>;  ///< first `dimension` entries along the grid axes

enum class Shape { quadratic_bspline, gimp, linear };
enum class Transfer { tflip, flip, apic, xpic };
enum class Update { usl, musl, usf };
enum class Reference { current, initial, adaptive };
enum class GridPressure { fluids, none, all };  ///< bodies of step/grid_pressure.hpp
enum class BoundaryKind { open, symmetry, wall, sticky, velocity };

struct Boundary {
  BoundaryKind kind = BoundaryKind::open;
  double friction = 0;  ///< wall: Coulomb coefficient
  Triple velocity{};    ///< kind velocity: prescribed velocity of the nodes on and beyond the plane
                        ///< [m/s]
  std::string where;
};

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
  bool dormant_blocks = true;                ///< skip what is at rest (the bits are the same)
  Reference reference = Reference::current;  ///< configuration of the weights (theory 3)
  double refresh_strain = 0.3;  ///< adaptive: largest Green-Lagrange strain before a new reference
};

enum class ContactNormal { volume_gradient, logistic_regression };

/// Contact of velocity fields; every body has its own while it is on.
struct ContactOptions {
  bool active = false;
  ContactNormal normal = ContactNormal::volume_gradient;
  int fields = 0;
  std::vector<double> friction;  ///< Coulomb coefficient by pair of fields, fields x fields
  double friction_of(int a, int b) const {
    return friction[static_cast<std::size_t>(a * fields + b)];
  }
};

}  // namespace krater
