// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/geometry/meshes/round_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace krater {

namespace {

constexpr double kPi = std::numbers::pi;

/// How a ball or disc of radius 1 is cut up: c and k of the inner block, and elements per radius
/// along the block and across the ring.
struct Pattern {
  double core, bulge, along, across;
};
const Pattern kDisc{0.45, 1 - std::sqrt(3.0) / 2, 0.58, 0.43};
constexpr Pattern kBall{0.4, 0.1, 0.56, 0.4};

int count_of(double elements) { return std::max(1, static_cast<int>(std::lround(elements))); }

/// Directions at equal angles between an axis and the diagonal.
double slope(int i, int n) { return i == n ? 1 : std::tan(kPi / 4 * i / n); }

/// Nodes of the inner block, (i, j, k) in 0 .. n, and of the layers beyond those of its outer
/// faces, made when they are first asked for.
template <std::size_t Dim>
class Octant {
 public:
  Octant(double radius, double element, const Pattern& pattern)
      : radius_{radius},
        pattern_{pattern},
        n_{count_of(pattern.along * radius / element)},
        m_{count_of(pattern.across * radius / element)},
        numbers_(static_cast<std::size_t>((m_ + 1) * (n_ + 1) * (n_ + 1) * (Dim == 3 ? n_ + 1 : 1)),
                 -1) {
    mesh_.dimension = Dim;
    add_core();
    for (std::size_t a = 0; a < Dim; ++a) add_shell(a);
  }
  Mesh take() { return std::move(mesh_); }

 private:
  using Place = std::array<int, 3>;

  std::int32_t node(const Place& at, int layer) {
    const int place = ((layer * (n_ + 1) + at[0]) * (n_ + 1) + at[1]) * (Dim == 3 ? n_ + 1 : 1) +
                      (Dim == 3 ? at[2] : 0);
    std::int32_t& number = numbers_[static_cast<std::size_t>(place)];
    if (number < 0) {
      number = static_cast<std::int32_t>(mesh_.nodes.size());
      mesh_.nodes.push_back(position(at, layer));
    }
    return number;
  }

  Vector3 position(const Place& at, int layer) const {
    Vector3 inner{}, outer{};
    for (std::size_t a = 0; a < Dim; ++a) {
      double bulge = 0;
      for (std::size_t b = 0; b < Dim; ++b)
        bulge += b == a ? 0 : 1 - 1.0 * at[b] * at[b] / (1.0 * n_ * n_);
      inner[a] = pattern_.core * radius_ * at[a] / n_ * (1 + pattern_.bulge * bulge);
      outer[a] = slope(at[a], n_);
    }
    const double length = std::sqrt(dot(outer, outer)), share = 1.0 * layer / m_;
    if (layer == 0) return inner;
    for (std::size_t a = 0; a < Dim; ++a)
      inner[a] = (1 - share) * inner[a] + share * (radius_ / length * outer[a]);
    return inner;
  }

  void add_core() {
    for (int k = 0; k < (Dim == 3 ? n_ : 1); ++k)
      for (int j = 0; j < n_; ++j)
        for (int i = 0; i < n_; ++i)
          for (std::size_t I = 0; I < (Dim == 3 ? 8 : 4); ++I) {
            const auto& step = kCornerSteps[I];
            mesh_.elements.push_back(node({i + step[0], j + step[1], k + step[2]}, 0));
          }
  }

  /// Beyond the face of the block across axis a, bottoms on the block.
  void add_shell(std::size_t a) {
    const std::size_t b = (a + 1) % Dim, c = (a + 2) % 3;
    for (int layer = 0; layer < m_; ++layer)
      for (int q = 0; q < (Dim == 3 ? n_ : 1); ++q)
        for (int p = 0; p < n_; ++p)
          for (std::size_t I = 0; I < (Dim == 3 ? 8 : 4); ++I) {
            const auto& step = kCornerSteps[I];
            Place at{};
            at[a] = n_;
            if constexpr (Dim == 3) {
              at[b] = p + step[0];
              at[c] = q + step[1];
              mesh_.elements.push_back(node(at, layer + step[2]));
            } else {  // outwards and along b turn the same way about the plane for a = 0 only
              at[b] = p + step[a == 0 ? 1 : 0];
              mesh_.elements.push_back(node(at, layer + step[a == 0 ? 0 : 1]));
            }
          }
  }

  double radius_;
  Pattern pattern_;
  int n_, m_;
  std::vector<std::int32_t> numbers_;
  Mesh mesh_;
};

template <std::size_t Dim>
Mesh with_halves(Mesh mesh, const std::array<Halves, Dim>& halves) {
  for (std::size_t a = 0; a < Dim; ++a)
    if (halves[a] != Halves::upper) mesh = mirrored(mesh, a, halves[a] == Halves::both);
  return mesh;
}

}  // namespace

Mesh disc_mesh(double radius, double element, const std::array<Halves, 2>& halves) {
  return with_halves<2>(Octant<2>{radius, element, kDisc}.take(), halves);
}

Mesh ball_mesh(double radius, double element, const std::array<Halves, 3>& halves) {
  return with_halves<3>(Octant<3>{radius, element, kBall}.take(), halves);
}

Mesh ring_mesh(double inner, double outer, double element, const std::array<Halves, 2>& halves) {
  const int around = count_of(kPi / 4 * (inner + outer) / element),
            across = count_of((outer - inner) / element);
  Mesh mesh = block_mesh(2, {0, 0, 0}, {1, 1, 0}, {across, around, 1});
  for (int j = 0; j <= around; ++j)
    for (int i = 0; i <= across; ++i) {
      const double share = 1.0 * i / across, angle = kPi / 2 * j / around,
                   r = (1 - share) * inner + share * outer;
      mesh.nodes[static_cast<std::size_t>(j * (across + 1) + i)] = {
          j == around ? 0 : r * std::cos(angle), r * std::sin(angle), 0};
    }
  return with_halves<2>(std::move(mesh), halves);
}

namespace {

constexpr double kMostElements = 5e7;
constexpr double kOnPlane = 1e-9;  // of the radius: the domain's side goes through the middle

/// The axes of a round body: two across it and one along, as unit vectors, and which axis of the
/// grid each is, -1 where it is none.
struct Axes {
  std::array<Vector3, 3> unit{};
  std::array<int, 3> grid{-1, -1, -1};
};

Axes axes_of(const RoundForm& form) {
  Axes out;
  for (std::size_t k = 0; k < 3; ++k)
    if (form.kind == RoundForm::Kind::sphere ? k == 2 : std::abs(form.axis[k]) > 1 - 1e-14)
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t axis = (k + 1 + i) % 3;
        out.grid[i] = static_cast<int>(axis);
        out.unit[i][axis] = 1;
      }
  if (out.grid[2] >= 0) return out;
  const bool mostly_x = std::abs(form.axis[0]) > 0.7;
  Vector3 across = cross(form.axis, mostly_x ? Vector3{0, 1, 0} : Vector3{1, 0, 0});
  const double length = std::sqrt(dot(across, across));
  for (double& x : across) x /= length;
  out.unit = {across, cross(form.axis, across), form.axis};
  return out;
}

std::string side_of(Frame frame, int axis, bool upper) {
  return std::string{axis_name(frame, axis)} + (upper ? "_max" : "_min");
}

/// Which halves about `middle` the domain leaves of what reaches `radius` to either side.
Halves halves_in(Frame frame, const Box& domain, int axis, double middle, double radius) {
  const auto a = static_cast<std::size_t>(axis);
  const double tolerance = kOnPlane * radius;
  const bool cut_below = domain.min[a] > middle - radius + tolerance,
             cut_above = domain.max[a] < middle + radius - tolerance;
  if (!cut_below && !cut_above) return Halves::both;
  const double plane = cut_below ? domain.min[a] : domain.max[a];
  if ((cut_below && cut_above) || std::abs(plane - middle) > tolerance)
    throw std::invalid_argument(
        "is cut by the side " + side_of(frame, axis, cut_above) +
        " of the domain, which does not go through its middle: a round mesh ends at planes through "
        "its axis or centre and across its axis only; move the side or the body");
  return cut_below ? Halves::upper : Halves::lower;
}

/// Round sections of the two-dimensional frames.
Mesh plane_round_mesh(const RoundForm& form, Frame frame, const Box& domain, double element) {
  double radius = form.outer;
  if (form.kind == RoundForm::Kind::sphere)
    radius = std::sqrt(std::max(0.0, radius * radius - form.base[1] * form.base[1]));
  const std::array<double, 2> middle{form.base[0], form.base[2]};
  Box inside = domain;
  if (frame == Frame::axisymmetric) inside.min[0] = std::max(inside.min[0], 0.0);
  std::array<Halves, 2> halves{};
  for (std::size_t a = 0; a < 2; ++a)
    halves[a] = halves_in(frame, inside, static_cast<int>(a), middle[a], radius);
  Mesh mesh = form.inner > 0 ? ring_mesh(form.inner, radius, element, halves)
                             : disc_mesh(radius, element, halves);
  for (Vector3& x : mesh.nodes)
    for (std::size_t a = 0; a < 2; ++a) x[a] += middle[a];
  return mesh;
}

Mesh space_round_mesh(const RoundForm& form, const Solid& solid, const Box& domain,
                      double element) {
  const Frame frame = Frame::cartesian_3d;
  const Axes axes = axes_of(form);
  const bool ball = form.kind == RoundForm::Kind::sphere;
  std::array<Halves, 3> halves{};
  Vector3 base = form.base;
  double low = 0, high = form.height;
  for (std::size_t i = 0; i < (ball ? 3U : 2U); ++i)
    if (axes.grid[i] >= 0)
      halves[i] = halves_in(frame, domain, axes.grid[i],
                            base[static_cast<std::size_t>(axes.grid[i])], form.outer);
  if (axes.grid[2] < 0) {
    const Box extent = solid.extent(frame);
    for (int a = 0; a < 3; ++a) {
      const auto k = static_cast<std::size_t>(a);
      if (extent.min[k] < domain.min[k] || extent.max[k] > domain.max[k])
        throw std::invalid_argument("lies askew and sticks out of the domain at " +
                                    side_of(frame, a, extent.max[k] > domain.max[k]) +
                                    ": a round mesh is cut along its own axes only");
    }
  } else if (!ball) {
    const auto k = static_cast<std::size_t>(axes.grid[2]);
    const double end = base[k] + form.axis[k] * form.height;
    low = std::max(std::min(base[k], end), domain.min[k]);
    high = std::min(std::max(base[k], end), domain.max[k]);
    base[k] = 0;
  }
  const std::array<Halves, 2> across{halves[0], halves[1]};
  Mesh mesh = ball ? ball_mesh(form.outer, element, halves)
                   : extruded(form.inner > 0 ? ring_mesh(form.inner, form.outer, element, across)
                                             : disc_mesh(form.outer, element, across),
                              low, high, count_of((high - low) / element));
  Affine place;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t a = 0; a < 3; ++a) place.linear[3 * a + i] = axes.unit[i][a];
  place.shift = base;
  return mapped(mesh, frame, place);
}

}  // namespace

Mesh round_mesh(const Solid& solid, Frame frame, const Box& domain, double element) {
  const std::optional<RoundForm> form = solid.round_form();
  const double content = solid.part(frame, domain).section;
  if (content / std::pow(element, dimension(frame)) > kMostElements)
    throw std::invalid_argument("would have more than 5e7 elements: use a larger element");
  const bool tube = form && form->kind == RoundForm::Kind::tube;
  if (form && frame == Frame::cartesian_3d) return space_round_mesh(*form, solid, domain, element);
  if (form && tube == (frame == Frame::plane_strain && std::abs(form->axis[1]) > 1 - 1e-14))
    return plane_round_mesh(*form, frame, domain, element);
  throw std::invalid_argument(
      "has no mesh of its own: boxes, cylinders, tubes and spheres have (in plane strain "
      "cylinders and tubes along y); for other shapes give a file of elements, shape: {mesh: "
      "{file: ..., unit: ...}}, or use kinematics: mpm");
}

}  // namespace krater
