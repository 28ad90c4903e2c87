// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/mesh/mesh_health.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinematics/mesh/elements.hpp"
#include "krater/core/parallel.hpp"
#include "krater/kinematics/mesh/element.hpp"

namespace krater {

namespace {

constexpr std::size_t kChunkGroups = 256;
constexpr double kTouched = 0.1;  // of the mean energy of an element: less has hardly been touched

using Lanes = std::array<double, kLanes>;
/// Corners of a lane group.
using GroupCorners = std::array<std::array<Lanes, 3>, 8>;

/// The corner beyond corner I along axis k of the unit cube.
constexpr std::size_t neighbour(int dim, int I, int k) {
  for (int J = 0; J < corner_nodes(dim); ++J) {
    bool beside = true;
    for (int a = 0; a < dim; ++a)
      beside = beside && (corner_sign(dim, I, a) == corner_sign(dim, J, a)) == (a != k);
    if (beside) return static_cast<std::size_t>(J);
  }
  return 0;
}

/// Edges at a corner: to whom, and with which sign.
struct CornerEdge {
  std::size_t to;
  double sign;
};
template <int Dim>
constexpr auto corner_edges() {
  std::array<std::array<CornerEdge, 3>, 8> out{};
  for (int I = 0; I < corner_nodes(Dim); ++I)
    for (int k = 0; k < Dim; ++k)
      out[static_cast<std::size_t>(I)][static_cast<std::size_t>(k)] = {neighbour(Dim, I, k),
                                                                       -corner_sign(Dim, I, k)};
  return out;
}

/// det of the edges at corner I, by lanes: this is a plain loop for the compiler to vectorise.
template <int Dim>
Lanes corner_jacobians(const GroupCorners& x, std::size_t I) {
  static constexpr auto kEdges = corner_edges<Dim>();
  std::array<std::array<Lanes, 3>, 3> e;
  for (std::size_t k = 0; k < Dim; ++k)
    for (std::size_t a = 0; a < Dim; ++a)
      for (std::size_t l = 0; l < kLanes; ++l)
        e[k][a][l] = kEdges[I][k].sign * (x[kEdges[I][k].to][a][l] - x[I][a][l]);
  Lanes j;
  for (std::size_t l = 0; l < kLanes; ++l) {
    const auto minor = [&e, l](std::size_t a, std::size_t b) {
      return e[0][a][l] * e[1][b][l] - e[0][b][l] * e[1][a][l];
    };
    if constexpr (Dim == 2)
      j[l] = minor(0, 1);
    else
      j[l] = e[2][0][l] * minor(1, 2) + e[2][1][l] * minor(2, 0) + e[2][2][l] * minor(0, 1);
  }
  return j;
}

template <int Dim>
Lanes least_corners(const GroupCorners& x) {
  constexpr int N = corner_nodes(Dim);
  Lanes least, sum{};
  least.fill(std::numeric_limits<double>::infinity());
  for (std::size_t I = 0; I < N; ++I) {
    const Lanes j = corner_jacobians<Dim>(x, I);
    for (std::size_t l = 0; l < kLanes; ++l) {
      least[l] = std::min(least[l], j[l]);
      sum[l] += j[l];
    }
  }
  for (std::size_t l = 0; l < kLanes; ++l) least[l] *= N / std::abs(sum[l]);
  return least;
}

Lanes least_corners(int dim, const GroupCorners& x) {
  return dim == 3 ? least_corners<3>(x) : least_corners<2>(x);
}

void gather(const MeshHealth& more, MeshHealth& sum) {
  sum.elements += more.elements;
  sum.folded += more.folded;
  sum.hourglass += more.hourglass;
  sum.internal += more.internal;
  if (!(more.least_corner < sum.least_corner)) return;
  sum.least_corner = more.least_corner;
  sum.worst_body = more.worst_body;
  sum.worst_element = more.worst_element;
}

/// Element e, whose least j is known.
void add_element(const MeshStep::Elements& b, std::size_t e, double j, MeshHealth& sum) {
  const int i = static_cast<int>(e);
  const double held = b.hourglass_energy.data()[e],
               strained = b.elements.at(b.columns.mass, i) * b.elements.at(b.columns.energy, i);
  gather({.elements = 1,
          .folded = j < 0 ? std::size_t{1} : 0,
          .least_corner = j,
          .worst_body = b.made_of.body,
          .worst_element = e,
          .hourglass = held,
          .internal = held + strained},
         sum);
}

MeshHealth health_of(const MeshStep::Elements& b, std::size_t first_group, std::size_t last_group) {
  MeshHealth sum;
  const std::size_t count = b.made_of.mesh.element_count();
  for (std::size_t g = first_group; g < last_group; ++g) {
    const Lanes j = least_corners(b, g);
    for (std::size_t l = 0; l < kLanes && g * kLanes + l < count; ++l)
      add_element(b, g * kLanes + l, j[l], sum);
  }
  return sum;
}

/// Elements whose hourglass has more than `least` and more than all else in them [J].
std::size_t held_elements(const MeshStep::Elements& b, double least) {
  std::size_t count = 0;
  for (int i = 0; i < b.elements.count(); ++i) {
    const double held = b.hourglass_energy.data()[i];
    if (held > least &&
        held > std::abs(b.elements.at(b.columns.mass, i) * b.elements.at(b.columns.energy, i)))
      ++count;
  }
  return count;
}

}  // namespace

double least_corner(int dimension, std::span<const Triple> corners) {
  GroupCorners x{};
  for (std::size_t I = 0; I < corners.size(); ++I)
    for (std::size_t a = 0; a < 3; ++a) x[I][a].fill(corners[I][a]);
  return least_corners(dimension, x)[0];
}

std::array<double, kLanes> least_corners(const MeshStep::Elements& b, std::size_t group) {
  GroupCorners x;
  const std::size_t N = b.corner_count();
  for (std::size_t I = 0; I < N; ++I)
    for (std::size_t l = 0; l < kLanes; ++l) {
      const auto n = static_cast<std::size_t>(b.corners[(group * N + I) * kLanes + l]);
      for (std::size_t a = 0; a < 3; ++a) x[I][a][l] = b.nodes.data()[kNode * n + a];
    }
  return least_corners(b.made_of.mesh.dimension, x);
}

MeshHealth MeshStep::health() const {
  MeshHealth sum;
  for (const auto& body : bodies_) {
    const auto groups = static_cast<std::size_t>(body->elements.groups());
    std::vector<MeshHealth> parts((groups + kChunkGroups - 1) / kChunkGroups);
    for_each(parts.size(), [&](std::size_t c) {
      parts[c] = health_of(*body, c * kChunkGroups, std::min((c + 1) * kChunkGroups, groups));
    });
    for (const MeshHealth& part : parts) gather(part, sum);
  }
  const double mean = sum.internal / static_cast<double>(std::max<std::size_t>(1, sum.elements));
  for (const auto& body : bodies_) sum.held += held_elements(*body, kTouched * mean);
  return sum;
}

}  // namespace krater
