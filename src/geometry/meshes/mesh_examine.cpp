// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/meshes/mesh_examine.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <unordered_map>

#include <fmt/format.h>
#include <Eigen/Dense>

#include "krater/geometry/solids/box.hpp"

namespace krater {

namespace {

constexpr double kFlat = 1e-9;  // scaled Jacobian of an element without volume
constexpr double kOn = 1e-6;    // of an element: on its face

/// Buckets of a lattice: what lies near a place.
class Buckets {
 public:
  explicit Buckets(double cell) : cell_{cell} {}
  void add(const Vector3& x, std::size_t item) { at_[key(place(x))].push_back(item); }
  /// visit(item) for all in the cells that a box touches.
  template <class Visit>
  void in(const Box& box, const Visit& visit) const {
    const auto low = place(box.min), high = place(box.max);
    for (auto i = low[0]; i <= high[0]; ++i)
      for (auto j = low[1]; j <= high[1]; ++j)
        for (auto k = low[2]; k <= high[2]; ++k)
          if (const auto found = at_.find(key({i, j, k})); found != at_.end())
            for (const std::size_t item : found->second) visit(item);
  }

 private:
  using Place = std::array<std::int64_t, 3>;
  Place place(const Vector3& x) const {
    Place out{};
    for (std::size_t a = 0; a < 3; ++a)
      out[a] = static_cast<std::int64_t>(std::floor(x[a] / cell_));
    return out;
  }
  /// Different places may share a key: then more is visited than need be.
  static std::uint64_t key(const Place& p) {
    std::uint64_t h = 0;
    for (const std::int64_t x : p) {
      h = (h ^ static_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15ULL;
      h ^= h >> 29;
    }
    return h;
  }
  double cell_;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> at_;
};

double distance(const Vector3& a, const Vector3& b) {
  const Vector3 d = minus(a, b);
  return std::sqrt(dot(d, d));
}

/// Where in the unit cube of an element a point lies: greatest |xi|, infinite where Newton's
/// iteration does not find it.
double reach_in(const Mesh& mesh, std::size_t e, const Vector3& x) {
  const int dim = mesh.dimension;
  Eigen::Vector3d xi = Eigen::Vector3d::Zero();
  for (int step = 0; step < 20; ++step) {
    Eigen::Vector3d rest{-x[0], -x[1], -x[2]};
    Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
    J.topLeftCorner(dim, dim).setZero();
    for (std::size_t I = 0; I < static_cast<std::size_t>(mesh.corners()); ++I) {
      const Vector3& corner = mesh.corner(e, I);
      Eigen::Vector3d factor = Eigen::Vector3d::Ones(), sign;
      for (int k = 0; k < dim; ++k) {
        sign[k] = kCornerSteps[I][static_cast<std::size_t>(k)] == 1 ? 1 : -1;
        factor[k] = 0.5 * (1 + sign[k] * xi[k]);
      }
      for (int a = 0; a < dim; ++a) {
        rest[a] += factor.prod() * corner[static_cast<std::size_t>(a)];
        for (int k = 0; k < dim; ++k) {
          Eigen::Vector3d other = factor;
          other[k] = 0.5 * sign[k];
          J(a, k) += other.prod() * corner[static_cast<std::size_t>(a)];
        }
      }
    }
    if (dim == 2) rest[2] = 0;
    const Eigen::Vector3d change = J.partialPivLu().solve(rest);
    if (!change.allFinite()) break;
    xi -= change;
    if (xi.cwiseAbs().maxCoeff() > 1e3) break;
    if (change.norm() < 1e-10) return xi.head(dim).cwiseAbs().maxCoeff();
  }
  return std::numeric_limits<double>::infinity();
}

Box box_of(const Mesh& mesh, std::size_t e) {
  Box box{mesh.corner(e, 0), mesh.corner(e, 0)};
  for (std::size_t I = 1; I < static_cast<std::size_t>(mesh.corners()); ++I)
    for (std::size_t a = 0; a < 3; ++a) {
      box.min[a] = std::min(box.min[a], mesh.corner(e, I)[a]);
      box.max[a] = std::max(box.max[a], mesh.corner(e, I)[a]);
    }
  return box;
}

/// Node n, at the surface, and element e, of which it is no corner.
void require_apart(const Mesh& mesh, std::size_t e, std::size_t n, const MeshNames& names) {
  const double reach = reach_in(mesh, e, mesh.nodes[n]);
  if (!(reach <= 1 + kOn)) return;
  const Box box = box_of(mesh, e);
  const double size = distance(box.min, box.max);
  for (std::size_t I = 0; I < static_cast<std::size_t>(mesh.corners()); ++I) {
    const std::int32_t corner = mesh.elements[e * static_cast<std::size_t>(mesh.corners()) + I];
    if (distance(mesh.corner(e, I), mesh.nodes[n]) > kOn * size) continue;
    throw std::invalid_argument(fmt::format(
        "{}: its node {} and node {} lie in the same place: what meets there is not joined; merge "
        "the nodes in the program that made the mesh, or here, merge_nodes: {:.1g} m",
        names.element(e), names.node(static_cast<std::size_t>(corner)), names.node(n),
        10 * kOn * size));
  }
  const char* where = reach < 1 - kOn ? "in" : "on a face of";
  throw std::invalid_argument(fmt::format(
      "{}: node {} lies {} it and is none of its corners: {}", names.element(e), names.node(n),
      where,
      reach < 1 - kOn ? "elements overlap; make the mesh again, or make them bodies of their own"
                      : "the meshes do not match there, and tied surfaces are not computed; let "
                        "elements meet node by node, or make them bodies of their own"));
}

void examine_faces(const Mesh& mesh, const MeshNames& names) {
  struct Seen {
    MeshFace around;
    std::size_t first = 0;
    int count = 0;
  };
  std::map<MeshFace, Seen> faces;
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    for (const MeshFace& around : faces_of_element(mesh, e)) {
      MeshFace key = around;
      std::sort(key.begin(), key.end());
      Seen& seen = faces[key];
      if (++seen.count == 1) {
        seen.around = around;
        seen.first = e;
        continue;
      }
      if (seen.count > 2)
        throw std::invalid_argument(fmt::format(
            "{} has a face that two others have too, the first of them {}: elements are there "
            "twice, or overlap; remove one",
            names.element(e), names.element(seen.first)));
      const std::size_t corners = mesh.dimension == 3 ? 4 : 2;
      const auto at = static_cast<std::size_t>(
          std::find(seen.around.begin(), seen.around.end(), around[0]) - seen.around.begin());
      const bool turned = corners == 2 ? at == 1 : seen.around[(at + 3) % 4] == around[1];
      if (!turned)
        throw std::invalid_argument(fmt::format(
            "{} lies on the same side of a face as {}: they overlap; remove one, or make the mesh "
            "again",
            names.element(e), names.element(seen.first)));
    }
}

}  // namespace

std::size_t merge_nodes(Mesh& mesh, double distance_allowed, std::vector<std::size_t>& node_of) {
  Buckets buckets{2 * distance_allowed};
  std::vector<std::int32_t> number(mesh.nodes.size());
  Mesh out{mesh.dimension, {}, {}};
  std::vector<std::size_t> kept;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    const Vector3& x = mesh.nodes[n];
    Box box{x, x};
    for (std::size_t a = 0; a < 3; ++a) {
      box.min[a] -= distance_allowed;
      box.max[a] += distance_allowed;
    }
    std::size_t same = out.nodes.size();
    buckets.in(box, [&](std::size_t other) {
      if (distance(out.nodes[other], x) <= distance_allowed) same = std::min(same, other);
    });
    number[n] = static_cast<std::int32_t>(same);
    if (same < out.nodes.size()) continue;
    buckets.add(x, same);
    out.nodes.push_back(x);
    kept.push_back(node_of[n]);
  }
  for (const std::int32_t n : mesh.elements)
    out.elements.push_back(number[static_cast<std::size_t>(n)]);
  const std::size_t gone = mesh.nodes.size() - out.nodes.size();
  mesh = std::move(out);
  node_of = std::move(kept);
  return gone;
}

std::size_t turn_clockwise(Mesh& mesh) {
  std::size_t turned = 0;
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const Vector3 a = minus(mesh.corner(e, 2), mesh.corner(e, 0)),
                  b = minus(mesh.corner(e, 3), mesh.corner(e, 1));
    if (!(a[0] * b[1] - a[1] * b[0] < 0)) continue;
    std::swap(mesh.elements[4 * e + 1], mesh.elements[4 * e + 3]);
    ++turned;
  }
  return turned;
}

void examine_elements(const Mesh& mesh, const MeshNames& names) {
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    double least = 1, most = -1;
    std::int32_t worst = 0;
    for (std::size_t I = 0; I < static_cast<std::size_t>(mesh.corners()); ++I) {
      const double j = scaled_jacobian(mesh, e, I);
      most = std::max(most, j);
      if (j >= least) continue;
      least = j;
      worst = mesh.elements[e * static_cast<std::size_t>(mesh.corners()) + I];
    }
    if (least > kFlat) continue;
    const std::string at = names.node(static_cast<std::size_t>(worst));
    if (std::max(std::abs(least), std::abs(most)) <= kFlat)
      throw std::invalid_argument(names.element(e) +
                                  " has no volume: its nodes lie in a plane or "
                                  "line; remove it, or mend its nodes");
    if (most <= kFlat)
      throw std::invalid_argument(names.element(e) +
                                  " is inside out: its first four nodes must run counter-clockwise "
                                  "seen from the other four; change their order (was the mesh "
                                  "mirrored?)");
    throw std::invalid_argument(names.element(e) + " is folded or flat at its node " + at +
                                ": its nodes are out of order, or the mesh is too distorted there");
  }
}

void examine_joints(const Mesh& mesh, const MeshNames& names) {
  examine_faces(mesh, names);
  std::vector<bool> exposed(mesh.nodes.size(), false);
  for (const MeshFace& face : exposed_faces(mesh))
    for (const std::int32_t n : face)
      if (n >= 0) exposed[static_cast<std::size_t>(n)] = true;
  const MeshQuality quality = mesh_quality(mesh);
  Buckets buckets{std::sqrt(quality.shortest * quality.longest)};
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    if (exposed[n]) buckets.add(mesh.nodes[n], n);
  const auto corners = static_cast<std::size_t>(mesh.corners());
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const Box box = box_of(mesh, e);
    const double size = distance(box.min, box.max);
    Box wide = box;
    for (std::size_t a = 0; a < 3; ++a) {
      wide.min[a] -= kOn * size;
      wide.max[a] += kOn * size;
    }
    const auto first = mesh.elements.begin() + static_cast<std::ptrdiff_t>(e * corners);
    buckets.in(wide, [&](std::size_t n) {
      if (!encloses(wide, mesh.nodes[n])) return;
      const auto last = first + static_cast<std::ptrdiff_t>(corners);
      if (std::find(first, last, static_cast<std::int32_t>(n)) != last) return;
      require_apart(mesh, e, n, names);
    });
  }
}

}  // namespace krater
