// SPDX-License-Identifier: GPL-3.0-or-later
// Closed surfaces for the tests: lofts through rings of vertices.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "krater/geometry/surfaces/surface.hpp"

namespace krater::test {

using Ring = std::vector<std::array<double, 2>>;

inline double to_float(double x) { return static_cast<double>(static_cast<float>(x)); }

/// Corners of a regular polygon, each edge in `parts`, rounded to what STL can hold.
inline Ring polygon_ring(int corners, int parts, double radius) {
  Ring ring;
  for (int k = 0; k < corners; ++k) {
    const double a = 2 * std::numbers::pi * k / corners,
                 b = 2 * std::numbers::pi * (k + 1) / corners;
    const std::array<double, 2> p{to_float(radius * std::cos(a)), to_float(radius * std::sin(a))};
    const std::array<double, 2> q{to_float(radius * std::cos(b)), to_float(radius * std::sin(b))};
    for (int n = 0; n < parts; ++n) {
      ring.push_back({p[0] + (q[0] - p[0]) * n / parts, p[1] + (q[1] - p[1]) * n / parts});
    }
  }
  return ring;
}

/// Walls between neighbouring rings at rising heights, flat fans at both ends; outwards.
inline Triangles loft(const std::vector<Ring>& rings, const std::vector<double>& heights) {
  Triangles t;
  const std::size_t m = rings.front().size();
  for (std::size_t i = 0; i < rings.size(); ++i) {
    for (const auto& p : rings[i]) t.vertices.push_back({p[0], p[1], heights[i]});
  }
  const auto bottom = static_cast<std::uint32_t>(t.vertices.size());
  t.vertices.push_back({0, 0, heights.front()});
  t.vertices.push_back({0, 0, heights.back()});
  const auto at = [m](std::size_t i, std::size_t j) {
    return static_cast<std::uint32_t>(i * m + j % m);
  };
  for (std::size_t j = 0; j < m; ++j) {
    t.facets.push_back({bottom, at(0, j + 1), at(0, j)});
    t.facets.push_back({bottom + 1, at(rings.size() - 1, j), at(rings.size() - 1, j + 1)});
    for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
      t.facets.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      t.facets.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  }
  return t;
}

/// A ball with waves, n rings of 2 n vertices.
inline Triangles wavy_ball(int n, double radius) {
  std::vector<Ring> rings;
  std::vector<double> heights;
  Triangles t;
  const int m = 2 * n;
  const auto radius_at = [radius](double theta, double phi) {
    const double s = std::sin(theta);
    return radius * (1 + 0.1 * std::sin(7 * phi) * s * s * std::sin(5 * theta));
  };
  t.vertices.push_back({0, 0, radius});
  for (int i = 1; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      const double theta = std::numbers::pi * i / n, phi = 2 * std::numbers::pi * j / m;
      const double r = radius_at(theta, phi);
      t.vertices.push_back({r * std::sin(theta) * std::cos(phi),
                            r * std::sin(theta) * std::sin(phi), r * std::cos(theta)});
    }
  }
  t.vertices.push_back({0, 0, -radius});
  const auto at = [m](int i, int j) { return static_cast<std::uint32_t>(1 + (i - 1) * m + j % m); };
  const auto last = static_cast<std::uint32_t>(t.vertices.size() - 1);
  for (int j = 0; j < m; ++j) {
    t.facets.push_back({0, at(1, j), at(1, j + 1)});
    t.facets.push_back({last, at(n - 1, j + 1), at(n - 1, j)});
    for (int i = 1; i < n - 1; ++i) {
      t.facets.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      t.facets.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return t;
}

/// The surface of a box, two facets a side.
inline Triangles box_surface(const Box& b) {
  Triangles t;
  for (int c = 0; c < 8; ++c) {
    t.vertices.push_back(
        {c & 1 ? b.max[0] : b.min[0], c & 2 ? b.max[1] : b.min[1], c & 4 ? b.max[2] : b.min[2]});
  }
  t.facets = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
              {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return t;
}

inline void append(Triangles& to, const Triangles& more, bool inside_out = false) {
  const auto first = static_cast<std::uint32_t>(to.vertices.size());
  to.vertices.insert(to.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (auto f : more.facets) {
    if (inside_out) std::swap(f[1], f[2]);
    to.facets.push_back({f[0] + first, f[1] + first, f[2] + first});
  }
}

}  // namespace krater::test
