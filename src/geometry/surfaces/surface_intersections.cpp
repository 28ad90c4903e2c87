// SPDX-License-Identifier: GPL-3.0-or-later
// Self-intersections by CGAL's polygon mesh processing (bounding boxes, then exact predicates).
#include "geometry/surfaces/surface_intersections.hpp"

#include <iterator>
#include <stdexcept>
#include <utility>
#include <vector>

#include <CGAL/Polygon_mesh_processing/self_intersections.h>

#include "geometry/surfaces/surface_mesh.hpp"
#include "geometry/surfaces/surface_topology.hpp"

namespace krater {

std::vector<std::pair<std::size_t, std::size_t>> self_intersections(const Triangles& triangles) {
  std::vector<std::pair<std::size_t, std::size_t>> out;
  SurfaceMesh mesh;
  Triangles split;
  if (!make_mesh(triangles, mesh)) {
    split = triangles;
    split_pinched_vertices(split);
    mesh.clear();
    if (!make_mesh(split, mesh)) {
      throw std::invalid_argument("its facets join in a way that is no surface");
    }
  }
  // Fans of facets that meet at a pinch touch there, as they may.
  const auto pinched = [&](std::size_t a, std::size_t b) {
    for (std::size_t i = 0; i < (split.facets.empty() ? 0 : 3); ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        const bool same = triangles.facets[a][i] == triangles.facets[b][j];
        if (same && split.facets[a][i] != split.facets[b][j]) return true;
      }
    }
    return false;
  };
  std::vector<std::pair<SurfaceMesh::Face_index, SurfaceMesh::Face_index>> pairs;
  CGAL::Polygon_mesh_processing::self_intersections(mesh, std::back_inserter(pairs));
  for (const auto& [a, b] : pairs) {
    if (!pinched(a, b)) out.emplace_back(a, b);
  }
  return out;
}

}  // namespace krater
