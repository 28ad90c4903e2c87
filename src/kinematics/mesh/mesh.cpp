// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/mesh/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <stdexcept>
#include <utility>

#include <Eigen/Dense>

#include "krater/kinematics/mesh/element.hpp"

namespace krater {

Mesh block_mesh(int dimension, const Triple& lower, const Triple& upper,
                const std::array<int, 3>& counts) {
  const int layers = dimension == 3 ? counts[2] : 0;
  if (counts[0] < 1 || counts[1] < 1 || (dimension == 3 && layers < 1))
    throw std::invalid_argument("block_mesh: less than one element along an axis");
  Mesh mesh{dimension, {}, {}};
  const auto node = [&](int i, int j, int k) {
    return (k * (counts[1] + 1) + j) * (counts[0] + 1) + i;
  };
  for (int k = 0; k <= layers; ++k)
    for (int j = 0; j <= counts[1]; ++j)
      for (int i = 0; i <= counts[0]; ++i) {
        const std::array<int, 3> at{i, j, k};
        Triple x{};
        for (unsigned a = 0; a < static_cast<unsigned>(dimension); ++a) {
          const double share = static_cast<double>(at[a]) / counts[a];
          x[a] = (1 - share) * lower[a] + share * upper[a];
        }
        mesh.nodes.push_back(x);
      }
  for (int k = 0; k < std::max(1, layers); ++k)
    for (int j = 0; j < counts[1]; ++j)
      for (int i = 0; i < counts[0]; ++i)
        for (int I = 0; I < mesh.corners(); ++I) {
          const auto step = [&](int axis) { return corner_sign(dimension, I, axis) > 0 ? 1 : 0; };
          const int up = dimension == 3 ? step(2) : 0;
          mesh.elements.push_back(node(i + step(0), j + step(1), k + up));
        }
  return mesh;
}

std::array<int, 3> elements_along(Frame frame, const Triple& lower, const Triple& upper,
                                  double element) {
  std::array<int, 3> counts{1, 1, 1};
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension(frame)); ++a)
    counts[a] = std::max(1, static_cast<int>(std::lround((upper[a] - lower[a]) / element)));
  return counts;
}

NodeCorners node_corners(const Mesh& mesh) {
  NodeCorners out;
  out.first.assign(mesh.nodes.size() + 1, 0);
  for (const std::int32_t n : mesh.elements) ++out.first[static_cast<std::size_t>(n) + 1];
  std::partial_sum(out.first.begin(), out.first.end(), out.first.begin());
  out.places.resize(mesh.elements.size());
  std::vector<std::uint32_t> next(out.first.begin(), out.first.end() - 1);
  for (std::size_t p = 0; p < mesh.elements.size(); ++p)
    out.places[next[static_cast<std::size_t>(mesh.elements[p])]++] = static_cast<std::uint32_t>(p);
  return out;
}

const std::vector<std::vector<std::size_t>>& element_faces(int dimension) {
  static const std::vector<std::vector<std::size_t>> edges{{0, 1}, {1, 2}, {2, 3}, {3, 0}},
      faces{{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  return dimension == 2 ? edges : faces;
}

std::vector<std::array<std::int32_t, 4>> exposed_faces(const Mesh& mesh) {
  const auto corners = static_cast<std::size_t>(mesh.corners());
  using Face = std::array<std::int32_t, 4>;
  std::map<Face, std::pair<int, Face>> faces;
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    for (const auto& face : element_faces(mesh.dimension)) {
      Face around{-1, -1, -1, -1};
      for (std::size_t k = 0; k < face.size(); ++k)
        around[k] = mesh.elements[e * corners + face[k]];
      Face key = around;
      std::sort(key.begin(), key.end());
      auto& seen = faces[key];
      ++seen.first;
      seen.second = around;
    }
  std::vector<Face> exposed;
  for (const auto& [key, seen] : faces)
    if (seen.first == 1) exposed.push_back(seen.second);
  return exposed;
}

std::vector<std::array<std::int32_t, 2>> surface_edges(
    const std::vector<std::array<std::int32_t, 4>>& faces) {
  std::set<std::array<std::int32_t, 2>> edges;
  for (const auto& face : faces) {
    const std::size_t corners = face[2] < 0 ? 2 : 4;
    for (std::size_t k = 0; k < corners; ++k) {
      const std::int32_t a = face[k], b = face[(k + 1) % corners];
      edges.insert({std::min(a, b), std::max(a, b)});
    }
  }
  return {edges.begin(), edges.end()};
}

namespace {

/// N_I and dN_I/dxi_k at a point of the unit cube.
struct Functions {
  std::array<double, 8> value{};
  std::array<std::array<double, 3>, 8> slope{};
};

Functions functions_at(int dim, const std::array<double, 3>& xi) {
  Functions out;
  for (int I = 0; I < corner_nodes(dim); ++I) {
    std::array<double, 3> factor{1, 1, 1}, sign{};
    for (int k = 0; k < dim; ++k) {
      const auto at = static_cast<std::size_t>(k);
      sign[at] = corner_sign(dim, I, k);
      factor[at] = 0.5 * (1 + sign[at] * xi[at]);
    }
    const auto i = static_cast<std::size_t>(I);
    out.value[i] = factor[0] * factor[1] * factor[2];
    out.slope[i] = {0.5 * sign[0] * factor[1] * factor[2], 0.5 * sign[1] * factor[0] * factor[2],
                    0.5 * sign[2] * factor[0] * factor[1]};
  }
  return out;
}

}  // namespace

std::vector<double> corner_volumes(const Mesh& mesh, bool axisymmetric) {
  const int dim = mesh.dimension;
  const auto corners = static_cast<std::size_t>(mesh.corners());
  const double g = 1 / std::sqrt(3.0);
  std::vector<Functions> points;
  for (int q = 0; q < corner_nodes(dim); ++q)
    points.push_back(functions_at(dim, {g * corner_sign(dim, q, 0), g * corner_sign(dim, q, 1),
                                        dim == 3 ? g * corner_sign(dim, q, 2) : 0}));
  std::vector<double> out(mesh.elements.size(), 0.0);
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    for (const Functions& at : points) {
      Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
      J.topLeftCorner(dim, dim).setZero();
      double r = 0;
      for (std::size_t I = 0; I < corners; ++I) {
        const Triple& x = mesh.nodes[static_cast<std::size_t>(mesh.elements[e * corners + I])];
        r += at.value[I] * x[0];
        for (int k = 0; k < dim; ++k)
          for (int a = 0; a < dim; ++a)
            J(k, a) += at.slope[I][static_cast<std::size_t>(k)] * x[static_cast<std::size_t>(a)];
      }
      const double volume = J.determinant() * (axisymmetric ? 2 * std::numbers::pi * r : 1.0);
      for (std::size_t I = 0; I < corners; ++I) out[e * corners + I] += at.value[I] * volume;
    }
  return out;
}

}  // namespace krater
