// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/geometry/meshes/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

namespace krater {

namespace {

/// Corners along the edges that leave corner I, right-handed; the third is not one in a plane.
constexpr std::array<std::array<std::size_t, 3>, 8> kAround{
    {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7}, {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}}};

double length_of(const Vector3& v) { return std::sqrt(dot(v, v)); }

}  // namespace

Mesh block_mesh(int dimension, const Vector3& lower, const Vector3& upper,
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
        Vector3 x{};
        for (unsigned a = 0; a < static_cast<unsigned>(dimension); ++a) {
          const double share = static_cast<double>(at[a]) / counts[a];
          x[a] = (1 - share) * lower[a] + share * upper[a];
        }
        mesh.nodes.push_back(x);
      }
  for (int k = 0; k < std::max(1, layers); ++k)
    for (int j = 0; j < counts[1]; ++j)
      for (int i = 0; i < counts[0]; ++i)
        for (std::size_t I = 0; I < static_cast<std::size_t>(mesh.corners()); ++I)
          mesh.elements.push_back(
              node(i + kCornerSteps[I][0], j + kCornerSteps[I][1], k + kCornerSteps[I][2]));
  return mesh;
}

std::array<int, 3> elements_along(Frame frame, const Vector3& lower, const Vector3& upper,
                                  double element) {
  std::array<int, 3> counts{1, 1, 1};
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension(frame)); ++a)
    counts[a] = std::max(1, static_cast<int>(std::lround((upper[a] - lower[a]) / element)));
  return counts;
}

const std::vector<std::vector<std::size_t>>& element_faces(int dimension) {
  static const std::vector<std::vector<std::size_t>> edges{{0, 1}, {1, 2}, {2, 3}, {3, 0}},
      faces{{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  return dimension == 2 ? edges : faces;
}

std::vector<MeshFace> faces_of_element(const Mesh& mesh, std::size_t element) {
  const auto corners = static_cast<std::size_t>(mesh.corners());
  const std::int32_t* own = mesh.elements.data() + element * corners;
  std::vector<MeshFace> out;
  for (const auto& face : element_faces(mesh.dimension)) {
    out.push_back({-1, -1, -1, -1});
    for (std::size_t k = 0; k < face.size(); ++k) out.back()[k] = own[face[k]];
  }
  return out;
}

std::vector<MeshFace> exposed_faces(const Mesh& mesh) {
  std::map<MeshFace, std::pair<int, MeshFace>> faces;
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    for (const MeshFace& around : faces_of_element(mesh, e)) {
      MeshFace key = around;
      std::sort(key.begin(), key.end());
      auto& seen = faces[key];
      ++seen.first;
      seen.second = around;
    }
  std::vector<MeshFace> exposed;
  for (const auto& [key, seen] : faces)
    if (seen.first == 1) exposed.push_back(seen.second);
  return exposed;
}

std::vector<std::array<std::int32_t, 2>> surface_edges(const std::vector<MeshFace>& shown) {
  std::set<std::array<std::int32_t, 2>> edges;
  for (const MeshFace& face : shown) {
    const std::size_t corners = face[2] < 0 ? 2 : 4;
    for (std::size_t k = 0; k < corners; ++k) {
      const std::int32_t a = face[k], b = face[(k + 1) % corners];
      edges.insert({std::min(a, b), std::max(a, b)});
    }
  }
  return {edges.begin(), edges.end()};
}

double scaled_jacobian(const Mesh& mesh, std::size_t element, std::size_t I) {
  const Vector3& x = mesh.corner(element, I);
  const Vector3 a = minus(mesh.corner(element, kAround[I][0]), x),
                b = minus(mesh.corner(element, kAround[I][1]), x),
                c = mesh.dimension == 3 ? minus(mesh.corner(element, kAround[I][2]), x)
                                        : Vector3{0, 0, 1};
  const double lengths = length_of(a) * length_of(b) * length_of(c);
  return lengths > 0 ? dot(cross(a, b), c) / lengths : 0;
}

MeshQuality mesh_quality(const Mesh& mesh) {
  MeshQuality out;
  out.shortest = std::numeric_limits<double>::infinity();
  const std::size_t edges = mesh.dimension == 3 ? 3 : 2;
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    for (std::size_t I = 0; I < static_cast<std::size_t>(mesh.corners()); ++I) {
      const double j = scaled_jacobian(mesh, e, I);
      if (j < out.least_jacobian) {
        out.least_jacobian = j;
        out.worst_element = e;
      }
      for (std::size_t k = 0; k < edges; ++k) {
        const double length = length_of(minus(mesh.corner(e, kAround[I][k]), mesh.corner(e, I)));
        out.shortest = std::min(out.shortest, length);
        out.longest = std::max(out.longest, length);
      }
    }
  return out;
}

Mesh mirrored(const Mesh& mesh, std::size_t axis, bool both) {
  Mesh out{mesh.dimension, {}, {}};
  if (both) out = mesh;
  std::vector<std::int32_t> image(mesh.nodes.size());
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    Vector3 x = mesh.nodes[n];
    image[n] = static_cast<std::int32_t>(n);
    if (both && x[axis] == 0) continue;
    if (x[axis] != 0) x[axis] = -x[axis];
    image[n] = static_cast<std::int32_t>(out.nodes.size());
    out.nodes.push_back(x);
  }
  constexpr std::array<std::size_t, 8> turned{0, 3, 2, 1, 4, 7, 6, 5};
  const auto corners = static_cast<std::size_t>(mesh.corners());
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    for (std::size_t I = 0; I < corners; ++I)
      out.elements.push_back(
          image[static_cast<std::size_t>(mesh.elements[e * corners + turned[I]])]);
  return out;
}

Mesh extruded(const Mesh& plane, double low, double high, int layers) {
  Mesh out{3, {}, {}};
  const auto count = static_cast<std::int32_t>(plane.nodes.size());
  for (int k = 0; k <= layers; ++k) {
    const double share = static_cast<double>(k) / layers;
    for (Vector3 x : plane.nodes) {
      x[2] = (1 - share) * low + share * high;
      out.nodes.push_back(x);
    }
  }
  for (std::int32_t k = 0; k < layers; ++k)
    for (std::size_t e = 0; e < plane.element_count(); ++e)
      for (const std::int32_t above : {k, k + 1})
        for (std::size_t I = 0; I < 4; ++I)
          out.elements.push_back(plane.elements[4 * e + I] + above * count);
  return out;
}

Mesh mapped(const Mesh& mesh, Frame frame, const Affine& map) {
  Mesh out = mesh;
  for (Vector3& x : out.nodes) {
    const Vector3 before = to_space(frame, x), after = map.apply(before);
    if (dimension(frame) == 3) {
      x = after;
      continue;
    }
    const double size = std::abs(after[0]) + std::abs(after[2]) + std::abs(x[0]) + std::abs(x[1]);
    if (std::abs(after[1]) > 1e-12 * size)
      throw std::invalid_argument(
          "a plane mesh would leave the plane y = 0: move it along x and z, "
          "turn it about y");
    x = {after[0], after[2], 0};
  }
  return out;
}

}  // namespace krater
