// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <map>
#include <numeric>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "geometry/surfaces/surface_intersections.hpp"
#include "geometry/surfaces/surface_topology.hpp"
#include "krater/geometry/surfaces/surface.hpp"

namespace krater {
namespace {

constexpr std::size_t places_told = 3;

class Examiner {
 public:
  explicit Examiner(const Triangles& t) : t_(t) {}

  SurfaceDefects run() {
    facets();
    edges();
    if (defects_.kinds.empty()) turned_parts();
    if (defects_.kinds.empty()) crossings();
    return std::move(defects_);
  }

 private:
  void add(const char* what, const char* remedy, const std::vector<Vector3>& at) {
    if (at.empty()) return;
    SurfaceDefects::Kind kind{what, remedy, at.size(), at};
    kind.places.resize(std::min(at.size(), places_told));
    defects_.kinds.push_back(std::move(kind));
  }

  Vector3 middle(std::size_t facet) const {
    const auto& f = t_.facets[facet];
    Vector3 m{};
    for (const std::uint32_t corner : f) m = plus(m, 1.0 / 3, t_.vertices[corner]);
    return m;
  }

  void facets() {
    std::vector<Vector3> flat, twice;
    for (std::size_t n = 0; n < t_.facets.size(); ++n) {
      if (has_no_area(t_, t_.facets[n])) flat.push_back(middle(n));
    }
    for (const std::size_t n : duplicate_facets(t_)) twice.push_back(middle(n));
    add("zero-area facets", "drop_facets: true", flat);
    add("duplicate facets", "drop_facets: true", twice);
  }

  void edges() {
    std::vector<Vector3> open, crowded, turned;
    for_edges(t_, [&](const HalfEdge* first, const HalfEdge* last) {
      const Vector3 at =
          plus(plus({}, 0.5, t_.vertices[first->low]), 0.5, t_.vertices[first->high]);
      if (last - first == 1) open.push_back(at);
      if (last - first > 2) crowded.push_back(at);
      if (last - first == 2 && first->up == first[1].up) turned.push_back(at);
    });
    add("open edges (a hole, or corners that do not meet)",
        "close_holes or merge_vertices: a length", open);
    add("edges with more than two facets", "", crowded);
    add("edges whose facets are turned differently", "orient: true", turned);
  }

  /// Along a line the winding number of a well-made surface is 0 or 1.
  void turned_parts() {
    const std::vector<std::uint32_t> part = connected_parts(t_);
    std::map<std::uint32_t, std::size_t> widest;  // of every part, its facet seen best along z
    for (std::size_t n = 0; n < t_.facets.size(); ++n) {
      const auto [at, is_new] = widest.try_emplace(part[n], n);
      if (!is_new && std::abs(area_along_z(n)) > std::abs(area_along_z(at->second))) at->second = n;
    }
    std::vector<Vector3> wrong;
    for (const auto& [unused, facet] : widest) {
      if (!winding_is_sound(middle(facet))) wrong.push_back(middle(facet));
    }
    add("parts turned inside out, nested the same way round, or overlapping", "orient: true",
        wrong);
  }

  double area_along_z(std::size_t n) const {
    const auto& f = t_.facets[n];
    return cross(minus(t_.vertices[f[1]], t_.vertices[f[0]]),
                 minus(t_.vertices[f[2]], t_.vertices[f[0]]))[2];
  }

  bool winding_is_sound(const Vector3& at) const {
    std::vector<std::pair<double, int>> steps;
    for (std::size_t n = 0; n < t_.facets.size(); ++n) {
      const auto& f = t_.facets[n];
      const Vector3 &a = t_.vertices[f[0]], &b = t_.vertices[f[1]], &c = t_.vertices[f[2]];
      const auto area = [](const Vector3& p, const Vector3& q, const Vector3& r) {
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
      };
      const double wa = area(at, b, c), wb = area(at, c, a), wc = area(at, a, b);
      const bool up = wa > 0 && wb > 0 && wc > 0;
      if (!up && !(wa < 0 && wb < 0 && wc < 0)) continue;
      steps.emplace_back((wa * a[2] + wb * b[2] + wc * c[2]) / (wa + wb + wc), up ? -1 : 1);
    }
    std::sort(steps.begin(), steps.end());
    int winding = 0;
    bool sound = true;
    for (const auto& [z, step] : steps) {
      winding += step;
      sound = sound && winding >= 0 && winding <= 1;
    }
    // A line through an edge may miss a crossing: then it tells nothing.
    return sound || winding != 0;
  }

  void crossings() {
    std::vector<Vector3> at;
    for (const auto& [a, b] : self_intersections(t_)) {
      at.push_back(plus(plus({}, 0.5, middle(a)), 0.5, middle(b)));
    }
    add("pairs of facets that cross each other", "", at);
  }

  const Triangles& t_;
  SurfaceDefects defects_;
};

}  // namespace

SurfaceDefects examine_surface(const Triangles& triangles) { return Examiner(triangles).run(); }

std::string SurfaceDefects::text(double unit, const std::string& unit_name) const {
  std::string out;
  for (const Kind& kind : kinds) {
    out += (out.empty() ? "" : "; ") + std::to_string(kind.count) + " " + kind.what + ", at ";
    for (std::size_t n = 0; n < kind.places.size(); ++n) {
      const Vector3& x = kind.places[n];
      char place[120];
      std::snprintf(place, sizeof place, "%s(%.6g, %.6g, %.6g)", n == 0 ? "" : " ", x[0] / unit,
                    x[1] / unit, x[2] / unit);
      out += place;
    }
    out += (kind.count > kind.places.size() ? " ... " : " ") + unit_name;
    if (kind.remedy[0] != '\0') out += std::string(" (repair: {") + kind.remedy + "})";
  }
  return out;
}

bool has_no_area(const Triangles& t, const std::array<std::uint32_t, 3>& f) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  if (f[0] == f[1] || f[1] == f[2] || f[2] == f[0]) return true;
  const auto point = [&](std::uint32_t n) {
    const Vector3& x = t.vertices[n];
    return Kernel::Point_3(x[0], x[1], x[2]);
  };
  return CGAL::collinear(point(f[0]), point(f[1]), point(f[2]));
}

}  // namespace krater
