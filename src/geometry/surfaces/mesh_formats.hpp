// SPDX-License-Identifier: GPL-3.0-or-later
// Readers of single formats, for read_triangles. Lengths as in the file.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "krater/geometry/surfaces/triangles.hpp"

namespace krater {

Triangles read_stl(const std::string& file, std::string_view data);
Triangles read_off(const std::string& file, std::string_view data);
Triangles read_obj(const std::string& file, std::string_view data);
Triangles read_ply(const std::string& file, std::string_view data);

/// A face as a fan of triangles. Throws for an index that is no vertex.
inline void add_face(const std::vector<std::int64_t>& corners, std::size_t vertices,
                     Triangles& out) {
  if (corners.size() < 3) throw std::invalid_argument("a face has fewer than three corners");
  for (const std::int64_t c : corners) {
    if (c < 0 || c >= static_cast<std::int64_t>(vertices)) {
      throw std::invalid_argument("a face names vertex " + std::to_string(c) + " of " +
                                  std::to_string(vertices) + " (counted from 0)");
    }
  }
  for (std::size_t n = 1; n + 1 < corners.size(); ++n) {
    out.facets.push_back({static_cast<std::uint32_t>(corners[0]),
                          static_cast<std::uint32_t>(corners[n]),
                          static_cast<std::uint32_t>(corners[n + 1])});
  }
}

}  // namespace krater
