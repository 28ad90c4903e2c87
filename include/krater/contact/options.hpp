// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file contact/options.hpp
/// What a scene may choose about the sides of the domain and about contact between bodies.
#include <array>
#include <string>
#include <vector>

namespace krater {

using Triple = std::array<double, 3>;  ///< first `dimension` entries along the grid axes

enum class BoundaryKind { open, symmetry, wall, sticky, velocity };

struct Boundary {
  BoundaryKind kind = BoundaryKind::open;
  double friction = 0;  ///< wall: Coulomb coefficient
  Triple velocity{};    ///< kind velocity: of the plane [m/s]
  std::string where;

  bool closed() const { return kind != BoundaryKind::open; }  ///< points do not leave here
  /// What is beyond is the image of what is inside: the grid's sums are folded before the forces.
  bool folds() const { return kind == BoundaryKind::symmetry || kind == BoundaryKind::sticky; }
  /// A body of its own that pushes and does not pull: after the momentum update.
  bool pushes() const { return kind == BoundaryKind::wall || kind == BoundaryKind::velocity; }
  bool drives() const { return kind == BoundaryKind::velocity; }  ///< moves material by itself
  /// The plane itself moves, along its normal `axis`.
  bool travels(int axis) const { return drives() && velocity[static_cast<unsigned>(axis)] != 0; }
  /// The domain ends here for good: fillings and sections may be continued by their images.
  bool mirrors(int axis) const { return closed() && !travels(axis); }
};

/// Who pushes: a body, or a side of the domain, 2 axis + (0 lower, 1 upper).
struct Partner {
  enum class Kind { body, side };
  Kind kind = Kind::body;
  int number = -1;
  static constexpr Partner side(int axis, int upper) { return {Kind::side, 2 * axis + upper}; }
  friend bool operator==(const Partner&, const Partner&) = default;
};

enum class ContactNormal { volume_gradient, logistic_regression };

/// Contact of velocity fields; every body has its own while it is on.
struct ContactOptions {
  bool active = false;
  ContactNormal normal = ContactNormal::volume_gradient;
  std::string where;
  int fields = 0;
  std::vector<double> friction;  ///< Coulomb coefficient by pair of bodies, fields x fields
  double friction_of(int a, int b) const {
    return friction[static_cast<std::size_t>(a * fields + b)];
  }
};

}  // namespace krater
