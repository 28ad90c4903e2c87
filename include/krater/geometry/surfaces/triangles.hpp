// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles as read from a file, before anything is known of the surface they make. Formats: STL
// (ASCII, binary), OFF, OBJ, PLY (ASCII, binary of either byte order). Faces with more corners are
// cut into fans (their winding about any line stays right, convex or not).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "krater/geometry/seeds/line.hpp"

namespace krater {

struct Triangles {
  std::vector<Vector3> vertices;
  std::vector<std::array<std::uint32_t, 3>> facets;
};

/// Format by the file's ending; lengths are multiplied by `unit` (m). Vertices that are equal to
/// the last bit are welded in STL, which has no other way to say that facets join, and in surfaces
/// that their own numbering leaves open (corners listed once per face). Throws
/// std::invalid_argument with file, line or byte and what is wrong; counts in a header are believed
/// only as far as the file is long.
Triangles read_triangles(const std::string& file, double unit);

/// Vertices nearer than `distance` to an earlier one become that one (0: equal ones only); unused
/// ones are dropped. Returns how many went.
std::size_t weld(Triangles& triangles, double distance);

/// Binary STL, lengths divided by `unit`. Throws std::invalid_argument when it cannot be written.
void write_stl(const Triangles& triangles, const std::string& file, double unit);

}  // namespace krater
