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
// A solid has to know its `spans` on lines and its bounding box (or `support`); the rest follows by
// adaptive quadrature over lines along z (column.hpp). Box, cylinder and sphere (primitives.hpp)
// override it with exact formulas.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>

#include "krater/geometry/frame.hpp"
#include "krater/geometry/seeds/line.hpp"
#include "krater/geometry/seeds/moments.hpp"
#include "krater/geometry/seeds/section.hpp"
#include "krater/geometry/solids/affine.hpp"
#include "krater/geometry/solids/box.hpp"
#include "krater/geometry/solids/round_form.hpp"

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

struct Mesh;

enum class Place { outside, inside, cut };

class Solid {
 public:
  virtual ~Solid() = default;

  /// The parts of a line in the solid. Surfaces (surface.hpp) know lines along x, y or z only;
  /// `transformed` never asks them for others.
  virtual void spans(const Line& line, Spans& out) const = 0;

  /// Is the point of 3D space in the closed solid?
  virtual bool contains(double x, double y, double z) const;

  /// In 3D space; infinite where the solid is. By `support` unless overridden; one of the two must
  /// be.
  virtual Box bounding_box() const;

  /// Greatest d . x over the solid (an upper bound for intersections and differences).
  virtual double support(const Vector3& d) const;

  /// Is the solid one of revolution about this line?
  virtual bool revolved_about(const Line&) const { return false; }

  /// Exact moments of the whole solid, where known in closed form (to round-off).
  virtual std::optional<VolumeMoments> moments() const { return std::nullopt; }

  /// Of spheres, cylinders and tubes, moved, turned and scaled evenly too.
  virtual std::optional<RoundForm> round_form() const { return std::nullopt; }

  /// The elements that the solid was read as; null: it has none.
  virtual const Mesh* elements() const { return nullptr; }

  /// The image under a map, for solids that know better than to map every line; null: wrap it.
  virtual std::shared_ptr<const Solid> mapped(const Affine&) const { return nullptr; }

  /// Of a solid that was only moved, turned and scaled evenly as a whole: the solid before, and the
  /// map. Else null.
  virtual const Solid* unmapped(Affine&) const { return nullptr; }

  /// Throws std::invalid_argument, with the reason, if the solid has no meaning in the frame.
  virtual void require(Frame frame) const;

  /// The bounding box of the solid or of its section, in grid axes.
  virtual Box extent(Frame frame) const;

  /// Conservative: `cut` may be said of any cell, the others only if they are true.
  virtual Place classify(Frame frame, const Box& cell) const;

  /// The part of a cell in the solid; for cells of a lattice.
  virtual CellPart clip(Frame frame, const Box& cell) const;

  /// The parts of cells that lie above each other along the last axis: same bounds across it,
  /// ascending along it. `parts` has their number; empty cells give empty parts.
  virtual void clip_column(Frame frame, std::span<const Box> cells, CellPart* parts) const;

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

/// The image of a solid under an affine map. Throws std::invalid_argument for a singular map.
std::shared_ptr<const Solid> transformed(std::shared_ptr<const Solid> solid, const Affine& map);

}  // namespace krater
