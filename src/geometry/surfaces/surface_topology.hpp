// SPDX-License-Identifier: GPL-3.0-or-later
// What facets share: edges, duplicates, connected parts.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "krater/geometry/surfaces/triangles.hpp"

namespace krater {

/// An edge as one facet has it; `up`: from the lower to the higher vertex.
struct HalfEdge {
  std::uint32_t low, high, facet;
  bool up;
};

/// Facets whose corners lie on a line (exact), or that name a vertex twice.
bool has_no_area(const Triangles& t, const std::array<std::uint32_t, 3>& f);

/// Facets with the corners of an earlier one, in any order.
std::vector<std::size_t> duplicate_facets(const Triangles& t);

/// A number for every facet, equal for facets joined by edges.
std::vector<std::uint32_t> connected_parts(const Triangles& t);

/// Vertices at which several fans of facets meet only there (a pinch) become one for each fan;
/// facets keep their order, vertices their places.
void split_pinched_vertices(Triangles& t);

std::vector<HalfEdge> sorted_half_edges(const Triangles& t);

/// visit(first, last): the half-edges of one edge.
template <class Visit>
void for_edges(const Triangles& t, Visit&& visit) {
  const std::vector<HalfEdge> list = sorted_half_edges(t);
  for (std::size_t n = 0; n < list.size();) {
    std::size_t m = n + 1;
    while (m < list.size() && list[m].low == list[n].low && list[m].high == list[n].high) ++m;
    visit(list.data() + n, list.data() + m);
    n = m;
  }
}

}  // namespace krater
