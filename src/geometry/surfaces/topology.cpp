// SPDX-License-Identifier: GPL-3.0-or-later
#include <numeric>
#include <utility>

#include "geometry/surfaces/surface_topology.hpp"

namespace krater {
namespace {

/// Disjoint sets, each known by its least member.
class Groups {
 public:
  explicit Groups(std::size_t count) : above_(count) {
    std::iota(above_.begin(), above_.end(), 0U);
  }
  std::uint32_t root(std::uint32_t n) {
    while (above_[n] != n) n = above_[n] = above_[above_[n]];
    return n;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    above_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> above_;
};

}  // namespace

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
  Groups parts(t.facets.size());
  for_edges(t, [&](const HalfEdge* first, const HalfEdge* last) {
    for (const HalfEdge* e = first + 1; e < last; ++e) parts.join(first->facet, e->facet);
  });
  std::vector<std::uint32_t> part(t.facets.size());
  for (std::uint32_t n = 0; n < part.size(); ++n) part[n] = parts.root(n);
  return part;
}

void split_pinched_vertices(Triangles& t) {
  const auto corner = [&t](std::uint32_t facet, std::uint32_t vertex) {
    const auto& f = t.facets[facet];
    return 3 * facet + (f[0] == vertex ? 0U : (f[1] == vertex ? 1U : 2U));
  };
  Groups fans(3 * t.facets.size());
  for_edges(t, [&](const HalfEdge* first, const HalfEdge* last) {
    for (const HalfEdge* e = first + 1; e < last; ++e) {
      for (const std::uint32_t v : {e->low, e->high}) {
        fans.join(corner(first->facet, v), corner(e->facet, v));
      }
    }
  });
  constexpr std::uint32_t none = 0xffffffff;
  std::vector<std::uint32_t> number(3 * t.facets.size(), none);
  Triangles out;
  for (std::uint32_t n = 0; n < number.size(); ++n) {
    const std::uint32_t root = fans.root(n), vertex = t.facets[n / 3][n % 3];
    if (number[root] == none) {
      number[root] = static_cast<std::uint32_t>(out.vertices.size());
      out.vertices.push_back(t.vertices[vertex]);
    }
    if (n % 3 == 0) out.facets.emplace_back();
    out.facets.back()[n % 3] = number[root];
  }
  t = std::move(out);
}

}  // namespace krater
