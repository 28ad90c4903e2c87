// SPDX-License-Identifier: GPL-3.0-or-later
// An axis-aligned box, the product of closed intervals. It serves two spaces, and each function
// says which: 3D space (x, y, z), or the grid's axes of a frame, of which the first
// `dimension(frame)` entries count (frame.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace krater {

struct Box {
  std::array<double, 3> min{};
  std::array<double, 3> max{};

  double length(int axis) const {
    const auto a = static_cast<std::size_t>(axis);
    return max[a] - min[a];
  }
  double middle(int axis) const {
    const auto a = static_cast<std::size_t>(axis);
    return 0.5 * (min[a] + max[a]);
  }
};

/// The common part over the first `dimensions` axes; the others are those of `a`. May be empty (see
/// `is_empty`).
inline Box intersection(const Box& a, const Box& b, int dimensions = 3) {
  Box c = a;
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimensions); ++k) {
    c.min[k] = std::max(a.min[k], b.min[k]);
    c.max[k] = std::min(a.max[k], b.max[k]);
  }
  return c;
}

/// No content: thinner than nothing, or flat, along one of the first `dimensions` axes.
inline bool is_empty(const Box& box, int dimensions = 3) {
  for (int k = 0; k < dimensions; ++k) {
    if (!(box.length(k) > 0)) return true;
  }
  return false;
}

/// `inner` lies in `outer` (touching allowed) along the first `dimensions` axes.
inline bool encloses(const Box& outer, const Box& inner, int dimensions = 3) {
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimensions); ++k) {
    if (inner.min[k] < outer.min[k] || inner.max[k] > outer.max[k]) return false;
  }
  return true;
}

inline bool encloses(const Box& outer, const std::array<double, 3>& x, int dimensions = 3) {
  return encloses(outer, Box{x, x}, dimensions);
}

}  // namespace krater
