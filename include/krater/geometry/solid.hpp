// SPDX-License-Identifier: GPL-3.0-or-later
// A solid of 3D space, and the content of its parts in a frame's measure.
//
//   3d            measure = int dV                     section = measure
//   plane_strain  measure = int dA over y = 0, x 1 m   section = measure
//   axisymmetric  measure = 2 pi int r dA, r >= 0      section = int dA
//
// Boxes given to `classify`, `clip` and `part` are in grid axes (frame.hpp). In 2D frames the
// section is the cut y = 0; in the axisymmetric frame its half x = r >= 0, and r < 0 never counts.
// A domain box with its minimum on a plane of symmetry thus makes the quarter or half body exactly.
//
// A solid has to know `contains` and `bounding_box`; the rest follows by adaptive subdivision,
// whose error falls with the finest cell. The primitives (primitives.hpp) override it with exact
// formulas.
#pragma once

#include <array>

#include "krater/geometry/box.hpp"
#include "krater/geometry/frame.hpp"
#include "krater/geometry/section.hpp"

namespace krater {

/// Content of a region. `centroid` (grid axes) weights with the measure: in the axisymmetric frame
/// int r (r, z) dA / int r dA.
struct CellPart {
  double measure = 0;
  std::array<double, 3> centroid{};
  double section = 0;

  CellPart& operator+=(const CellPart& other);
};

/// A whole box (r_min >= 0 where axisymmetric).
CellPart whole_box(Frame frame, const Box& box);

/// A region of the section of a 2D frame.
CellPart from_section(Frame frame, const PlaneMoments& moments);

/// The box without the half plane r < 0, which the axisymmetric frame does not have.
Box in_frame(Frame frame, Box box);

enum class Place { outside, inside, cut };

class Solid {
 public:
  virtual ~Solid() = default;

  /// Is the point of 3D space in the closed solid?
  virtual bool contains(double x, double y, double z) const = 0;

  /// In 3D space.
  virtual Box bounding_box() const = 0;

  /// Throws std::invalid_argument, with the reason, if the solid has no meaning in the frame.
  virtual void require(Frame) const {}

  /// The bounding box of the solid or of its section, in grid axes.
  virtual Box extent(Frame frame) const;

  /// Conservative: `cut` may be said of any cell, the others only if they are true.
  virtual Place classify(Frame frame, const Box& cell) const;

  /// The part of a cell in the solid; for cells of a lattice.
  virtual CellPart clip(Frame frame, const Box& cell) const;

  /// The part of a large box, such as the domain, in the solid.
  virtual CellPart part(Frame frame, const Box& domain) const;

  double measure(Frame frame, const Box& domain) const { return part(frame, domain).measure; }

  /// Membership of a point given in grid axes.
  bool contains(Frame frame, const std::array<double, 3>& grid_point) const {
    const std::array<double, 3> x = to_space(frame, grid_point);
    return contains(x[0], x[1], x[2]);
  }

  /// Least extent (m), along the grid axes, of what the domain leaves of the solid.
  double smallest_thickness(Frame frame, const Box& domain) const;
};

}  // namespace krater
