// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/mesh/conversion.hpp"

#include <algorithm>
#include <cmath>

#include "kinematics/mesh/elements.hpp"

namespace krater {

namespace {

constexpr double kMostParts = 4;  // along an axis
constexpr double kLongest = 0.6;  // of a part [cells]: half a cell, and some stretch

/// The corners of one element, now.
struct Corners {
  std::size_t count = 0, dim = 0;
  std::array<double, 8> mass{};
  std::array<Triple, 8> x{}, v{};
};

Corners corners_now(const MeshStep::Elements& b, int i) {
  Corners out{b.corner_count(), static_cast<std::size_t>(b.made_of.mesh.dimension), {}, {}, {}};
  for (std::size_t I = 0; I < out.count; ++I) {
    const std::size_t at = (static_cast<std::size_t>(i / kLanes) * out.count + I) * kLanes +
                           static_cast<std::size_t>(i % kLanes);
    const double* node = b.nodes.data() + kNode * static_cast<std::size_t>(b.corners[at]);
    out.mass[I] = b.shares.data()[at];
    for (std::size_t a = 0; a < out.dim; ++a) {
      out.x[I][a] = node[a];
      out.v[I][a] = node[4 + a];
    }
  }
  return out;
}

/// Parts along each axis of the element.
std::array<int, 3> parts_of(const Corners& at, double cell) {
  const std::array<double, 3> longest = longest_edges(static_cast<int>(at.dim), at.x);
  std::array<int, 3> out{1, 1, 1};
  for (std::size_t k = 0; k < at.dim; ++k)
    out[k] =
        static_cast<int>(std::clamp(std::ceil(longest[k] / (kLongest * cell)), 1.0, kMostParts));
  return out;
}

/// Of one part: mass, place, velocity and C, row by row.
struct SubElement {
  double mass = 0;
  Triple x{}, v{};
  std::array<double, 9> affine{};
};

SubElement part_of(const Corners& at, const std::array<double, 8>& mass, double moment) {
  SubElement out;
  for (std::size_t I = 0; I < at.count; ++I) out.mass += mass[I];
  for (std::size_t I = 0; I < at.count; ++I)
    for (std::size_t a = 0; a < at.dim; ++a) {
      out.x[a] += mass[I] / out.mass * at.x[I][a];
      out.v[a] += mass[I] / out.mass * at.v[I][a];
    }
  double twice = 0;  // of the energy about v_p
  for (std::size_t I = 0; I < at.count; ++I)
    for (std::size_t k = 0; k < at.dim; ++k) {
      twice += mass[I] * (at.v[I][k] - out.v[k]) * (at.v[I][k] - out.v[k]);
      for (std::size_t a = 0; a < at.dim; ++a)
        out.affine[at.dim * k + a] +=
            mass[I] / (out.mass * moment) * (at.v[I][k] - out.v[k]) * (at.x[I][a] - out.x[a]);
    }
  double of_affine = 0;
  for (const double C : out.affine) of_affine += out.mass * moment * C * C;
  if (of_affine > twice)
    for (double& C : out.affine) C *= std::sqrt(twice / of_affine);
  return out;
}

double kinetic_of(const SubElement& p, std::size_t dim, bool affine, double moment) {
  double twice = 0;
  for (std::size_t a = 0; a < dim; ++a) twice += p.v[a] * p.v[a];
  for (std::size_t k = 0; affine && k < dim * dim; ++k) twice += moment * p.affine[k] * p.affine[k];
  return 0.5 * p.mass * twice;
}

/// The middle of each part in [-1, 1]^dim, in the order of part_volumes().
std::vector<Triple> middles(const std::array<int, 3>& counts) {
  std::vector<Triple> out;
  for (int k = 0; k < counts[2]; ++k)
    for (int j = 0; j < counts[1]; ++j)
      for (int i = 0; i < counts[0]; ++i)
        out.push_back({(2 * i + 1.0) / counts[0] - 1, (2 * j + 1.0) / counts[1] - 1,
                       (2 * k + 1.0) / counts[2] - 1});
  return out;
}

Triple at_middle(const std::array<double, 8>& N, std::size_t corners,
                 const std::array<Triple, 8>& x) {
  Triple out{};
  for (std::size_t I = 0; I < corners; ++I)
    for (std::size_t a = 0; a < 3; ++a) out[a] += N[I] * x[I][a];
  return out;
}

}  // namespace

void convert_element(MeshStep::Elements& b, int i, bool axisymmetric) {
  const PointsOfElements& to = *b.made_of.points;
  const Mesh& mesh = b.made_of.mesh;
  const Corners at = corners_now(b, i);
  const auto element = static_cast<std::size_t>(i);
  std::array<int, 3> counts = parts_of(at, to.cell);
  std::vector<double> volumes = part_volumes(mesh, element, axisymmetric, counts);
  if (std::any_of(volumes.begin(), volumes.end(), [](double v) { return !(v > 0); })) {
    counts = {1, 1, 1};  // so skewed at the start that a part of it is inside out
    volumes = part_volumes(mesh, element, axisymmetric, counts);
  }
  const std::vector<Triple> middle = middles(counts);
  std::array<double, 8> whole{};
  std::array<Triple, 8> start{};
  for (std::size_t I = 0; I < at.count; ++I) {
    start[I] = mesh.corner(element, I);
    for (std::size_t p = 0; p < middle.size(); ++p) whole[I] += volumes[p * at.count + I];
  }
  double mass = 0, lost = 0;
  for (std::size_t I = 0; I < at.count; ++I) {
    mass += at.mass[I];
    for (std::size_t a = 0; a < at.dim; ++a) lost += 0.5 * at.mass[I] * at.v[I][a] * at.v[I][a];
  }
  const std::size_t first = b.converted.records.size(),
                    width = static_cast<std::size_t>(b.elements.stride() / kLanes);
  const auto put = [&](std::size_t p, int column, std::size_t component, double value) {
    if (column < 0) return;
    b.converted.records[first + p * width + static_cast<std::size_t>(column / kLanes) + component] =
        value;
  };
  const PointColumns& c = to.columns;
  for (std::size_t p = 0; p < middle.size(); ++p) {
    std::array<double, 8> share{};
    for (std::size_t I = 0; I < at.count; ++I)
      share[I] = volumes[p * at.count + I] / whole[I] * at.mass[I];
    SubElement part = part_of(at, share, to.moment);
    lost -= kinetic_of(part, at.dim, c.affine >= 0, to.moment);
    const std::array<double, 8> N = corner_functions(mesh.dimension, middle[p]);
    if (axisymmetric) part.x[0] = at_middle(N, at.count, at.x)[0];
    b.elements.copy_out(i, b.converted.records);
    put(p, b.columns.id, 0,
        number_of_part(static_cast<double>(b.first.alive.size()), b.elements.at(b.columns.id, i),
                       p));
    put(p, c.mass, 0, part.mass);
    const Triple reference = at_middle(N, at.count, start);
    for (std::size_t a = 0; a < at.dim; ++a) {
      put(p, c.position, a, part.x[a]);
      put(p, c.velocity, a, part.v[a]);
      put(p, to.reference_position, a, reference[a]);
    }
    for (std::size_t k = 0; k < at.dim * at.dim; ++k) put(p, c.affine, k, part.affine[k]);
  }
  const double heat = (lost + b.hourglass_energy.data()[i]) / mass;
  for (std::size_t p = 0; p < middle.size(); ++p)
    put(p, c.energy, 0, b.elements.at(c.energy, i) + heat);
  b.converted.heat += lost;
}

std::vector<ConvertedPoints> MeshStep::take_converted() {
  std::vector<ConvertedPoints> out;
  for (auto& b : bodies_) {
    if (b->converted.records.empty()) continue;
    b->converted.body = b->made_of.body;
    b->converted.barotropic = b->made_of.barotropic;
    out.push_back(std::move(b->converted));
    b->converted = {};
  }
  return out;
}

}  // namespace krater
