// SPDX-License-Identifier: GPL-3.0-or-later
#include <numeric>

#include "surface_topology.hpp"

namespace krater {

std::vector<HalfEdge> sorted_half_edges(const Triangles& t) {
  std::vector<HalfEdge> list;
  list.reserve(3 * t.facets.size());
  for (std::size_t n = 0; n < t.facets.size(); ++n) {
    const auto& f = t.facets[n];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = f[k], b = f[(k + 1) % 3];
      if (a == b) continue;
      list.push_back({std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(n), a < b});
    }
  }
  std::sort(list.begin(), list.end(), [](const HalfEdge& a, const HalfEdge& b) {
    if (a.low != b.low) return a.low < b.low;
    return a.high != b.high ? a.high < b.high : a.facet < b.facet;
  });
  return list;
}

std::vector<std::size_t> duplicate_facets(const Triangles& t) {
  std::vector<std::array<std::uint32_t, 4>> list(t.facets.size());
  for (std::size_t n = 0; n < list.size(); ++n) {
    auto f = t.facets[n];
    std::sort(f.begin(), f.end());
    list[n] = {f[0], f[1], f[2], static_cast<std::uint32_t>(n)};
  }
  std::sort(list.begin(), list.end());
  std::vector<std::size_t> out;
  for (std::size_t n = 1; n < list.size(); ++n) {
    if (std::equal(list[n].begin(), list[n].begin() + 3, list[n - 1].begin())) {
      out.push_back(list[n][3]);
    }
  }
  return out;
}

std::vector<std::uint32_t> connected_parts(const Triangles& t) {
  std::vector<std::uint32_t> part(t.facets.size());
  std::iota(part.begin(), part.end(), 0U);
  const auto root = [&part](std::uint32_t n) {
    while (part[n] != n) n = part[n] = part[part[n]];
    return n;
  };
  for_edges(t, [&](const HalfEdge* first, const HalfEdge* last) {
    for (const HalfEdge* e = first + 1; e < last; ++e) {
      const std::uint32_t a = root(first->facet), b = root(e->facet);
      part[std::max(a, b)] = std::min(a, b);
    }
  });
  for (std::uint32_t n = 0; n < part.size(); ++n) part[n] = root(n);
  return part;
}

}  // namespace krater
