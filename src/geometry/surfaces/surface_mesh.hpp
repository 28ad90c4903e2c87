// SPDX-License-Identifier: GPL-3.0-or-later
// Between triangles and CGAL's surface mesh; for surface_*.cpp only.
#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include "krater/geometry/surfaces/triangles.hpp"

namespace krater {

using SurfaceKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<SurfaceKernel::Point_3>;

/// Null if edges are not manifold, or neighbours are turned differently. Facet n is face n.
inline bool make_mesh(const Triangles& t, SurfaceMesh& mesh) {
  mesh.reserve(static_cast<SurfaceMesh::size_type>(t.vertices.size()),
               static_cast<SurfaceMesh::size_type>(t.facets.size() * 3 / 2),
               static_cast<SurfaceMesh::size_type>(t.facets.size()));
  for (const Vector3& x : t.vertices) mesh.add_vertex({x[0], x[1], x[2]});
  for (const auto& f : t.facets) {
    using Vertex = SurfaceMesh::Vertex_index;
    if (mesh.add_face(Vertex(f[0]), Vertex(f[1]), Vertex(f[2])) == SurfaceMesh::null_face()) {
      return false;
    }
  }
  return true;
}

inline Triangles from_mesh(const SurfaceMesh& mesh) {
  Triangles t;
  std::vector<std::uint32_t> number(mesh.number_of_vertices() + mesh.number_of_removed_vertices());
  for (const auto v : mesh.vertices()) {
    number[v] = static_cast<std::uint32_t>(t.vertices.size());
    const auto& p = mesh.point(v);
    t.vertices.push_back({p.x(), p.y(), p.z()});
  }
  for (const auto f : mesh.faces()) {
    const auto h = mesh.halfedge(f);
    t.facets.push_back({number[mesh.target(h)], number[mesh.target(mesh.next(h))],
                        number[mesh.target(mesh.next(mesh.next(h)))]});
  }
  return t;
}

}  // namespace krater
