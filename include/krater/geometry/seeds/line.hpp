// SPDX-License-Identifier: GPL-3.0-or-later
// Straight lines through 3D space and the parts of them that lie in a solid. A solid is known by
// its spans on lines: booleans become set operations on intervals, exact and of any depth, and
// contents of cells become sums over lines (column.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace krater {

using Vector3 = std::array<double, 3>;  ///< 3D space

/// x(t) = origin + t direction; the direction need not be of unit length.
struct Line {
  Vector3 origin{};
  Vector3 direction{};

  Vector3 at(double t) const {
    return {origin[0] + t * direction[0], origin[1] + t * direction[1],
            origin[2] + t * direction[2]};
  }
};

/// The line through `point` along coordinate axis 0, 1 or 2; its parameter is that coordinate.
inline Line along_axis(Vector3 point, int axis) {
  Line line{point, {}};
  line.origin[static_cast<std::size_t>(axis)] = 0;
  line.direction[static_cast<std::size_t>(axis)] = 1;
  return line;
}

/// Parameters from `low` to `high`.
struct Span {
  double low, high;
  double length() const { return high - low; }
};

/// Disjoint, ascending.
using Spans = std::vector<Span>;

enum class SetOperation { unite, intersect, subtract };

/// out = a operation b; `out` may be neither of them.
void combine(SetOperation operation, const Spans& a, const Spans& b, Spans& out);

}  // namespace krater
