// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of elements that lie on themselves (mesh_health.hpp).
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include <Eigen/Dense>

#include "kinematics/mesh/elements.hpp"
#include "krater/kinematics/mesh/element.hpp"

namespace krater {

namespace {

constexpr double kTwice = 1.2;       // filling that one layer of matter does not reach
constexpr double kMostSamples = 64;  // along an axis of an element

using Fillings = std::unordered_map<std::uint64_t, double>;

/// 21 bits of each index of a node.
std::uint64_t key_of(const std::array<std::int64_t, 3>& node) {
  std::uint64_t key = 0;
  for (const std::int64_t i : node) key = key << 21U | (static_cast<std::uint64_t>(i) & 0x1fffffU);
  return key;
}

Triple place_of(std::uint64_t key, double cell) {
  Triple out{};
  for (std::size_t a = 3; a-- > 0; key >>= 21U) {
    const auto low = static_cast<std::int64_t>(key & 0x1fffffU);
    out[a] = cell * static_cast<double>(low >= 0x100000 ? low - 0x200000 : low);
  }
  return out;
}

struct Corners {
  int dim;
  std::array<Triple, 8> x{};
};

/// Of one point of an element, of volume `share` in units of cells.
void add_sample(const Triple& x, double share, int dim, double cell, Fillings& out) {
  std::array<std::int64_t, 3> base{};
  Triple part{};
  for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a) {
    const double at = std::floor(x[a] / cell);
    base[a] = static_cast<std::int64_t>(at);
    part[a] = x[a] / cell - at;
  }
  for (int corner = 0; corner < (dim == 3 ? 8 : 4); ++corner) {
    std::array<std::int64_t, 3> node = base;
    double weight = share;
    for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a) {
      const bool upper = (corner >> a & 1) != 0;
      node[a] += upper ? 1 : 0;
      weight *= upper ? part[a] : 1 - part[a];
    }
    out[key_of(node)] += weight;
  }
}

/// x and det dx/dxi at a point of [-1, 1]^dim, out of plane as it is.
double map_at(const Corners& c, const Triple& xi, Triple& x) {
  Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
  J.topLeftCorner(c.dim, c.dim).setZero();
  x = {};
  for (int I = 0; I < corner_nodes(c.dim); ++I) {
    const auto i = static_cast<std::size_t>(I);
    std::array<double, 3> factor{1, 1, 1};
    for (int k = 0; k < c.dim; ++k)
      factor[static_cast<std::size_t>(k)] =
          0.5 * (1 + corner_sign(c.dim, I, k) * xi[static_cast<std::size_t>(k)]);
    for (int a = 0; a < c.dim; ++a) {
      const double at = c.x[i][static_cast<std::size_t>(a)];
      x[static_cast<std::size_t>(a)] += factor[0] * factor[1] * factor[2] * at;
      for (int k = 0; k < c.dim; ++k) {
        double slope = 0.5 * corner_sign(c.dim, I, k);
        for (int m = 0; m < c.dim; ++m)
          if (m != k) slope *= factor[static_cast<std::size_t>(m)];
        J(k, a) += slope * at;
      }
    }
  }
  return J.determinant();
}

/// Samples along each axis, no further apart than half a cell.
std::array<int, 3> samples_of(const Corners& c, double cell) {
  const std::array<double, 3> longest = longest_edges(c.dim, c.x);
  std::array<int, 3> out{1, 1, 1};
  for (std::size_t k = 0; k < static_cast<std::size_t>(c.dim); ++k)
    out[k] = static_cast<int>(std::clamp(std::ceil(2 * longest[k] / cell), 1.0, kMostSamples));
  return out;
}

/// Midpoints of parts.
void add_element(const Corners& c, double cell, Fillings& out) {
  const std::array<int, 3> n = samples_of(c, cell);
  double part = 1;
  for (int k = 0; k < c.dim; ++k) part *= 2.0 / (n[static_cast<std::size_t>(k)] * cell);
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        Triple x;
        const Triple xi{(2 * i + 1.0) / n[0] - 1, (2 * j + 1.0) / n[1] - 1,
                        (2 * k + 1.0) / n[2] - 1};
        const double volume = map_at(c, xi, x) * part;
        add_sample(x, volume, c.dim, cell, out);
      }
}

}  // namespace

MeshOverlap MeshStep::overlap(double cell) const {
  MeshOverlap out;
  for (const auto& b : bodies_) {
    Fillings filling;
    const Mesh& mesh = b->made_of.mesh;
    Corners c{dim_, {}};
    for (std::size_t e = 0; e < mesh.element_count(); ++e) {
      for (std::size_t I = 0; I < b->corner_count(); ++I) {
        const auto n = static_cast<std::size_t>(mesh.elements[e * b->corner_count() + I]);
        for (std::size_t a = 0; a < static_cast<std::size_t>(dim_); ++a) c.x[I][a] = b->node(n)[a];
      }
      add_element(c, cell, filling);
    }
    for (const auto& [key, phi] : filling) {
      if (!(phi > kTwice)) continue;
      ++out.nodes;
      if (phi > out.most || (phi == out.most && place_of(key, cell) < out.place)) {
        out.most = phi;
        out.body = b->made_of.body;
        out.place = place_of(key, cell);
      }
    }
  }
  return out;
}

}  // namespace krater
