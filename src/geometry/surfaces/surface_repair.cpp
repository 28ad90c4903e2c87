// SPDX-License-Identifier: GPL-3.0-or-later
// Repairs by CGAL's polygon mesh processing; only what is asked for, and everything is told.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/boost/graph/helpers.h>

#include "geometry/surfaces/surface_mesh.hpp"
#include "geometry/surfaces/surface_topology.hpp"
#include "krater/geometry/surfaces/surface.hpp"

namespace krater {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;

std::size_t drop_facets(Triangles& t) {
  std::vector<bool> gone(t.facets.size(), false);
  for (const std::size_t n : duplicate_facets(t)) gone[n] = true;
  for (std::size_t n = 0; n < t.facets.size(); ++n) {
    if (has_no_area(t, t.facets[n])) gone[n] = true;
  }
  std::size_t kept = 0;
  for (std::size_t n = 0; n < t.facets.size(); ++n) {
    if (!gone[n]) t.facets[kept++] = t.facets[n];
  }
  const std::size_t dropped = t.facets.size() - kept;
  t.facets.resize(kept);
  return dropped;
}

/// Neighbours the same way round, then outwards. False where that cannot be.
bool orient(Triangles& t) {
  std::vector<SurfaceKernel::Point_3> points;
  for (const Vector3& x : t.vertices) points.emplace_back(x[0], x[1], x[2]);
  std::vector<std::vector<std::size_t>> polygons;
  for (const auto& f : t.facets) polygons.push_back({f[0], f[1], f[2]});
  pmp::orient_polygon_soup(points, polygons);
  Triangles out;
  for (const auto& p : points) out.vertices.push_back({p.x(), p.y(), p.z()});
  for (const auto& p : polygons) {
    out.facets.push_back({static_cast<std::uint32_t>(p[0]), static_cast<std::uint32_t>(p[1]),
                          static_cast<std::uint32_t>(p[2])});
  }
  SurfaceMesh mesh;
  if (!make_mesh(out, mesh)) return false;
  if (CGAL::is_closed(mesh)) {
    pmp::orient_to_bound_a_volume(mesh);
    out = from_mesh(mesh);
  }
  t = std::move(out);
  return true;
}

double diagonal_of_hole(const SurfaceMesh& mesh, SurfaceMesh::Halfedge_index border) {
  CGAL::Bbox_3 box;
  auto h = border;
  do {
    box += mesh.point(mesh.target(h)).bbox();
    h = mesh.next(h);
  } while (h != border);
  return std::hypot(box.xmax() - box.xmin(), box.ymax() - box.ymin(), box.zmax() - box.zmin());
}

/// Holes closed and those found larger than `size`.
std::pair<std::size_t, std::size_t> close_holes(Triangles& t, double size) {
  SurfaceMesh mesh;
  if (!make_mesh(t, mesh)) return {0, 0};
  std::vector<SurfaceMesh::Halfedge_index> borders;
  std::vector<bool> seen(mesh.number_of_halfedges(), false);
  for (const auto start : mesh.halfedges()) {
    if (!mesh.is_border(start) || seen[start]) continue;
    borders.push_back(start);
    for (auto h = start; !seen[h]; h = mesh.next(h)) seen[h] = true;
  }
  std::size_t closed = 0, left = 0;
  for (const auto border : borders) {
    if (diagonal_of_hole(mesh, border) > size) {
      ++left;
      continue;
    }
    std::vector<SurfaceMesh::Face_index> patch;
    pmp::triangulate_hole(mesh, border, std::back_inserter(patch));
    ++(patch.empty() ? left : closed);
  }
  if (closed > 0) t = from_mesh(mesh);
  return {closed, left};
}

}  // namespace

std::vector<std::string> repair_surface(Triangles& t, const RepairOptions& options) {
  std::vector<std::string> done;
  const auto tell = [&done](std::size_t count, const std::string& what) {
    if (count > 0) done.push_back(std::to_string(count) + " " + what);
  };
  if (options.merge_vertices > 0) tell(weld(t, options.merge_vertices), "vertices merged");
  if (options.drop_facets) {
    tell(drop_facets(t), "facets of zero area or duplicates dropped");
    if (t.facets.empty())
      throw std::invalid_argument("none of its facets has an area: nothing is left to mend");
    weld(t, 0);
  }
  if (options.orient) {
    done.push_back(orient(t) ? "facets turned to bound a volume"
                             : "facets could not be turned to bound a volume");
  }
  if (options.close_holes > 0) {
    const auto [closed, left] = close_holes(t, options.close_holes);
    tell(closed, "holes closed");
    tell(left, "holes left open: larger than asked for, or not to be closed");
  }
  if (options.orient && options.close_holes > 0) orient(t);
  return done;
}

}  // namespace krater
