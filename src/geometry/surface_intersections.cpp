// SPDX-License-Identifier: GPL-3.0-or-later
// Self-intersections by CGAL's polygon mesh processing (bounding boxes, then exact predicates).
#include "surface_intersections.hpp"

#include <iterator>
#include <utility>
#include <vector>

#include <CGAL/Polygon_mesh_processing/self_intersections.h>

#include "surface_mesh.hpp"

namespace krater {

std::vector<std::pair<std::size_t, std::size_t>> self_intersections(const Triangles& triangles) {
  SurfaceMesh mesh;
  std::vector<std::pair<std::size_t, std::size_t>> out;
  if (!make_mesh(triangles, mesh)) return out;
  std::vector<std::pair<SurfaceMesh::Face_index, SurfaceMesh::Face_index>> pairs;
  CGAL::Polygon_mesh_processing::self_intersections(mesh, std::back_inserter(pairs));
  for (const auto& [a, b] : pairs) out.emplace_back(a, b);
  return out;
}

}  // namespace krater
