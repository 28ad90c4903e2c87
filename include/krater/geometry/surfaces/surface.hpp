// SPDX-License-Identifier: GPL-3.0-or-later
// Solids bounded by closed triangle surfaces.
//
// A line along an axis meets a facet if its projected corners turn the same way about the line's
// foot: CGAL's exact predicates decide, and a foot on an edge counts as moved by (e, e^2), so that
// facets that share an edge always agree and every line's crossings of a closed surface cancel.
// What lies between crossings is in where the winding number is positive. Heights of crossings are
// rounded; membership of a point is exact (orientation of point and facet).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "krater/geometry/solids/solid.hpp"
#include "krater/geometry/surfaces/triangles.hpp"

namespace krater {

/// What is wrong with a surface: how many of each kind, and where the first of them are (m).
struct SurfaceDefects {
  struct Kind {
    const char* what;    ///< "zero-area facets"
    const char* remedy;  ///< how the scene may mend it, or ""
    std::size_t count = 0;
    std::vector<Vector3> places;  ///< of the first few
  };
  std::vector<Kind> kinds;  ///< those found only
  bool any() const { return !kinds.empty(); }
  /// "3 open edges, at (1, 2, 3) mm ...; ..."; `unit` and its name for the places.
  std::string text(double unit, const std::string& unit_name) const;
};

/// Zero-area, duplicate facets, open, non-manifold and inconsistently oriented edges, parts turned
/// inside out; where none of these is found, self-intersections.
SurfaceDefects examine_surface(const Triangles& triangles);

struct RepairOptions {
  double merge_vertices = 0;  ///< m; vertices this near become one
  bool drop_facets = false;   ///< of zero area, and duplicates
  bool orient = false;        ///< turn facets so that the surface bounds a volume
  double close_holes = 0;     ///< m; holes whose boundary's box has a shorter diagonal are closed
};

/// Does what is asked, and says what was done, one line each.
std::vector<std::string> repair_surface(Triangles& triangles, const RepairOptions& options);

/// The solid inside a surface without defects (not checked here).
std::shared_ptr<const Solid> make_surface_solid(Triangles triangles);

}  // namespace krater
