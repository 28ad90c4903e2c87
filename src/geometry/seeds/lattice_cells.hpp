// SPDX-License-Identifier: GPL-3.0-or-later
// The cells of a staggered lattice over a region: index ranges, bounds, neighbours. Cell (i, j, k)
// is the interval number i, j along the grid's axes across the columns and k along its last axis
// (in 2D j = 0), counted from the grid's origin. Bounds shared by cells are computed by one
// expression, so that clipped contents add up to round-off.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "krater/geometry/seeds/lattice.hpp"

namespace krater {

struct CellIndex {
  std::int64_t i = 0, j = 0, k = 0;
};

/// Per grid axis, m.
inline std::array<double, 3> lattice_spacing(const LatticeOptions& options) {
  std::array<double, 3> s{};
  for (std::size_t a = 0; a < 3; ++a) {
    s[a] = options.spacing[a] > 0 ? options.spacing[a]
                                  : options.cell / options.points_per_direction[a];
  }
  return s;
}

class LatticeCells {
 public:
  LatticeCells(const Box& region, Frame frame, const LatticeOptions& options)
      : dimensions_(dimension(frame)),
        stagger_(options.stagger),
        spacing_(lattice_spacing(options)),
        origin_(options.origin) {
    for (int axis = 0; axis + 1 < dimensions_; ++axis) set_plane(axis, options.mirror);
    if (is_empty(region, dimensions_)) return;
    for (int axis = 0; axis < dimensions_; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const std::size_t n = axis == dimensions_ - 1 ? 2 : a;  // the last axis always runs in k
      const double low = std::floor((region.min[a] - origin_[a]) / spacing_[a]);
      const double high = std::ceil((region.max[a] - origin_[a]) / spacing_[a]);
      // Beyond this no index is exact, and no table would fit.
      if (!(std::abs(low) < 1e9) || !(std::abs(high) < 1e9)) {
        throw std::invalid_argument("the body is more than 1e9 lattice spacings large or away");
      }
      // One cell to spare on either side for round-off, and for the shift of odd columns.
      first_[n] = static_cast<std::int64_t>(low) - 1;
      last_[n] = static_cast<std::int64_t>(high);
    }
    if (static_cast<double>(span(0)) * static_cast<double>(span(1)) * static_cast<double>(span(2)) >
        4e10) {
      throw std::invalid_argument("more than 4e10 lattice cells in the body's bounding box");
    }
  }

  std::int64_t first(int n) const { return first_[static_cast<std::size_t>(n)]; }
  std::int64_t last(int n) const { return last_[static_cast<std::size_t>(n)]; }

  std::size_t count() const {
    return static_cast<std::size_t>(span(0)) * static_cast<std::size_t>(span(1)) *
           static_cast<std::size_t>(span(2));
  }

  bool has(const CellIndex& c) const {
    return c.i >= first_[0] && c.i <= last_[0] && c.j >= first_[1] && c.j <= last_[1] &&
           c.k >= first_[2] && c.k <= last_[2];
  }

  std::size_t slot(const CellIndex& c) const {
    return static_cast<std::size_t>(((c.i - first_[0]) * span(1) + (c.j - first_[1])) * span(2) +
                                    (c.k - first_[2]));
  }

  /// Is the column of this cell shifted by half a spacing along its own axis?
  bool shifted(const CellIndex& c) const {
    return stagger_ && ((outward(c.i, plane_[0]) + outward(c.j, plane_[1])) & 1) != 0;
  }

  /// Area (2D) or volume (3D) of a whole cell.
  double content() const {
    const double area = spacing_[0] * spacing_[1];
    return dimensions_ == 3 ? area * spacing_[2] : area;
  }

  /// Bounds in grid axes.
  Box box(const CellIndex& c) const {
    Box cell;
    set(cell, 0, static_cast<double>(c.i));
    if (dimensions_ == 3) set(cell, 1, static_cast<double>(c.j));
    set(cell, static_cast<std::size_t>(dimensions_ - 1),
        static_cast<double>(c.k) + (shifted(c) ? 0.5 : 0.0));
    return cell;
  }

  /// All cells that touch this one, if only at a corner (some may lie outside the ranges).
  template <class Visit>
  void for_neighbours(const CellIndex& c, Visit&& visit) const {
    const std::int64_t reach_j = dimensions_ == 3 ? 1 : 0;
    for (std::int64_t i = c.i - 1; i <= c.i + 1; ++i) {
      for (std::int64_t j = c.j - reach_j; j <= c.j + reach_j; ++j) {
        const bool aligned = shifted({i, j, c.k}) == shifted(c);
        // A column with the other shift touches with two cells only.
        const std::int64_t low = aligned || !shifted(c) ? c.k - 1 : c.k;
        const std::int64_t high = aligned || shifted(c) ? c.k + 1 : c.k;
        for (std::int64_t k = low; k <= high; ++k) {
          if (i != c.i || j != c.j || k != c.k) visit(CellIndex{i, j, k});
        }
      }
    }
  }

 private:
  void set_plane(int axis, const std::array<double, 2>& mirror) {
    const auto a = static_cast<std::size_t>(axis);
    const double column = (mirror[a] - origin_[a]) / spacing_[a];
    if (!(std::abs(column - std::round(column)) < 1e-6) || !(std::abs(column) < 1e9)) return;
    plane_[a] = static_cast<std::int64_t>(std::round(column));
  }

  /// Number of a column counted from the plane below column `plane`, the same to both sides.
  static std::int64_t outward(std::int64_t i, std::int64_t plane) {
    return i >= plane ? i - plane : plane - 1 - i;
  }

  std::int64_t span(int n) const { return last(n) - first(n) + 1; }

  void set(Box& cell, std::size_t axis, double index) const {
    cell.min[axis] = origin_[axis] + index * spacing_[axis];
    cell.max[axis] = origin_[axis] + (index + 1) * spacing_[axis];
  }

  int dimensions_;
  bool stagger_;
  std::array<double, 3> spacing_;
  std::array<double, 3> origin_;
  std::array<std::int64_t, 3> first_{};
  std::array<std::int64_t, 3> last_{};
  /// Counted from here. Without a plane of symmetry: an even number below all columns.
  std::array<std::int64_t, 2> plane_{-(std::int64_t{1} << 40), -(std::int64_t{1} << 40)};
};

}  // namespace krater
