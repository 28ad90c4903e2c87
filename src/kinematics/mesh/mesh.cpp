// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/mesh/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <Eigen/Dense>

#include "krater/kinematics/mesh/element.hpp"

namespace krater {

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

namespace {

/// Adds int N_I dV of the part about `centre`, of half-widths `half`, both in [-1, 1]^dim.
void add_part(const Mesh& mesh, std::size_t element, bool axisymmetric, const Vector3& centre,
              const Vector3& half, double* out) {
  const int dim = mesh.dimension;
  const auto corners = static_cast<std::size_t>(mesh.corners());
  const double g = 1 / std::sqrt(3.0);
  for (int q = 0; q < corner_nodes(dim); ++q) {
    std::array<double, 3> xi{};
    double share = 1;
    for (int k = 0; k < dim; ++k) {
      const auto a = static_cast<std::size_t>(k);
      xi[a] = centre[a] + half[a] * (g * corner_sign(dim, q, k));
      share *= half[a];
    }
    const Functions at = functions_at(dim, xi);
    Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
    J.topLeftCorner(dim, dim).setZero();
    double r = 0;
    for (std::size_t I = 0; I < corners; ++I) {
      const Triple& x = mesh.corner(element, I);
      r += at.value[I] * x[0];
      for (int k = 0; k < dim; ++k)
        for (int a = 0; a < dim; ++a)
          J(k, a) += at.slope[I][static_cast<std::size_t>(k)] * x[static_cast<std::size_t>(a)];
    }
    const double volume = J.determinant() * (axisymmetric ? 2 * std::numbers::pi * r : 1.0) * share;
    for (std::size_t I = 0; I < corners; ++I) out[I] += at.value[I] * volume;
  }
}

}  // namespace

std::array<double, 3> longest_edges(int dimension, const std::array<Triple, 8>& x) {
  std::array<double, 3> out{};
  for (int I = 0; I < corner_nodes(dimension); ++I)
    for (int J = I + 1; J < corner_nodes(dimension); ++J) {
      std::size_t axis = 0, differ = 0;
      double square = 0;
      for (int k = 0; k < dimension; ++k) {
        const auto a = static_cast<std::size_t>(k);
        const double by = x[static_cast<std::size_t>(J)][a] - x[static_cast<std::size_t>(I)][a];
        square += by * by;
        if (corner_sign(dimension, I, k) == corner_sign(dimension, J, k)) continue;
        axis = a;
        ++differ;
      }
      if (differ == 1) out[axis] = std::max(out[axis], std::sqrt(square));
    }
  return out;
}

std::array<double, 8> corner_functions(int dimension, const std::array<double, 3>& xi) {
  return functions_at(dimension, xi).value;
}

std::vector<double> part_volumes(const Mesh& mesh, std::size_t element, bool axisymmetric,
                                 const std::array<int, 3>& counts) {
  const auto corners = static_cast<std::size_t>(mesh.corners());
  std::vector<double> out;
  Vector3 centre{}, half{};
  for (std::size_t a = 0; a < 3; ++a) half[a] = 1.0 / counts[a];
  for (int k = 0; k < counts[2]; ++k)
    for (int j = 0; j < counts[1]; ++j)
      for (int i = 0; i < counts[0]; ++i) {
        centre = {(2 * i + 1) * half[0] - 1, (2 * j + 1) * half[1] - 1, (2 * k + 1) * half[2] - 1};
        out.resize(out.size() + corners);
        add_part(mesh, element, axisymmetric, centre, half, out.data() + out.size() - corners);
      }
  return out;
}

std::vector<double> corner_volumes(const Mesh& mesh, bool axisymmetric) {
  const auto corners = static_cast<std::size_t>(mesh.corners());
  std::vector<double> out(mesh.elements.size(), 0.0);
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    add_part(mesh, e, axisymmetric, {0, 0, 0}, {1, 1, 1}, out.data() + e * corners);
  return out;
}

}  // namespace krater
