// SPDX-License-Identifier: GPL-3.0-or-later
// Every shape against closed forms: volume, centroid, inertia; lines against membership; and the
// points made of it, whose mass must be right at any resolution.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "geometry_cases.hpp"
#include "krater/geometry/seeds/column.hpp"
#include "krater/geometry/solids/csg.hpp"
#include "krater/geometry/solids/shapes.hpp"

using namespace krater;
using namespace krater::test;

namespace {

using SolidPointer = std::shared_ptr<const Solid>;

/// A shape with its volume, height of the centroid and moments of inertia I_xx, I_zz about it, by
/// formulas of textbooks.
struct Shape {
  std::string name;
  SolidPointer solid;
  double volume, z, ixx, izz;
};

/// Tangent ogive by direct quadrature of its radius, y(z) = sqrt(S^2 - z^2) - (S - a), z from the
/// shank on; Simpson with 2000 intervals.
Shape ogive(const std::string& name, double a, double length, double crh) {
  const double s = 2 * crh * a, nose = a * std::sqrt(4 * crh - 1), shank = length - nose;
  double m[4]{};  // int r^2, r^2 z, r^2 z^2, r^4
  const int n = 2000;
  for (int i = 0; i <= n; ++i) {
    const double z = nose * i / n, r = std::sqrt(s * s - z * z) - (s - a);
    const double w = (i == 0 || i == n ? 1.0 : (i % 2 ? 4.0 : 2.0)) * nose / (3.0 * n);
    const double at = shank + z;
    m[0] += w * r * r, m[1] += w * r * r * at, m[2] += w * r * r * at * at;
    m[3] += w * r * r * r * r;
  }
  m[0] += a * a * shank, m[1] += a * a * shank * shank / 2;
  m[2] += a * a * shank * shank * shank / 3, m[3] += a * a * a * a * shank;
  const double v = pi * m[0], z = m[1] / m[0];
  return {name,         make_ogive(a, length, crh), v, z, pi * m[3] / 4 + pi * m[2] - v * z * z,
          pi * m[3] / 2};
}

std::vector<Shape> shapes() {
  const double r1 = 2, r2 = 3, h = 5;
  const double tube = pi * (r2 * r2 - r1 * r1) * h;
  const double cone = pi * r2 * r2 * h / 3;
  const double fru = pi * h / 3 * (r2 * r2 + r2 * r1 + r1 * r1);
  const double fru_z =
      h * (r2 * r2 + 2 * r2 * r1 + 3 * r1 * r1) / (4 * (r2 * r2 + r2 * r1 + r1 * r1));
  const double fru_izz = pi * h / 10 * (std::pow(r2, 5) - std::pow(r1, 5)) / (r2 - r1);
  // int z^2 dV of a frustum about its base
  const double fru_zz = pi * h * h * h * (r2 * r2 + 3 * r2 * r1 + 6 * r1 * r1) / 30;
  const double torus = 2 * pi * pi * r2 * 1;
  const double ell = 4 * pi / 3 * 2 * 3 * 4;
  const double hex = 3 * std::sqrt(3.0) / 2 * 4 * h, hex_i = 5 * std::sqrt(3.0) / 16 * 16;
  std::vector<std::array<double, 2>> hexagon;
  for (int k = 0; k < 6; ++k)
    hexagon.push_back({2 * std::cos(k * pi / 3), 2 * std::sin(k * pi / 3)});
  return {
      {"tube", make_tube(r1, r2, h), tube, h / 2, tube * (3 * (r1 * r1 + r2 * r2) + h * h) / 12,
       tube * (r1 * r1 + r2 * r2) / 2},
      {"cone", make_cone(r2, 0, h), cone, h / 4, cone * (3 * r2 * r2 / 20 + 3 * h * h / 80),
       0.3 * cone * r2 * r2},
      {"cone, tip down", make_cone(0, r2, h), cone, 3 * h / 4,
       cone * (3 * r2 * r2 / 20 + 3 * h * h / 80), 0.3 * cone * r2 * r2},
      {"frustum", make_cone(r2, r1, h), fru, fru_z, fru_izz / 2 + fru_zz - fru * fru_z * fru_z,
       fru_izz},
      {"torus", make_torus(r2, 1), torus, 0, torus * (r2 * r2 / 2 + 5.0 / 8),
       torus * (r2 * r2 + 0.75)},
      {"ellipsoid", make_ellipsoid({2, 2, 4}), ell * 2 / 3, 0, ell * 2 / 3 * (4 + 16) / 5,
       ell * 2 / 3 * 8 / 5},
      ogive("ogive crh 3", 1, 6, 3),
      ogive("ogive crh 6, nose only", 1, std::sqrt(23.0), 6),
      ogive("ogive crh 0.5: hemisphere", 1, 3, 0.5),
      {"hexagon extruded", make_extrusion(polygon_profile(hexagon), h), hex, h / 2,
       hex_i * h + hex * h * h / 12, 2 * hex_i * h},
  };
}

double size_of(const Solid& solid) {
  const Box b = solid.bounding_box();
  return std::max({b.length(0), b.length(1), b.length(2)});
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("shapes: volume, centroid and inertia are those of the closed forms") {
    for (const Shape& s : shapes()) {
      CAPTURE(s.name);
      const auto m = s.solid->moments();
      REQUIRE(m.has_value());
      const auto i = m->inertia();
      const double l2 = size_of(*s.solid) * size_of(*s.solid);
      CHECK(std::abs(m->volume / s.volume - 1) < 1e-12);
      CHECK(std::abs(m->centroid()[2] - s.z) < 1e-12 * size_of(*s.solid));
      CHECK(std::abs(m->centroid()[0]) < 1e-12);
      CHECK(std::abs(i[0] - s.ixx) < 1e-11 * s.volume * l2);
      CHECK(std::abs(i[1] - s.ixx) < 1e-11 * s.volume * l2);
      CHECK(std::abs(i[2] - s.izz) < 1e-11 * s.volume * l2);
      for (const int k : {3, 4, 5})
        CHECK(std::abs(i[static_cast<std::size_t>(k)]) < 1e-11 * s.volume * l2);
    }
  }

  TEST_CASE("shapes: quadrature over lines agrees with the closed forms, also when turned") {
    const Affine turn = Affine::move({3, -2, 1}) * Affine::rotate({1, 2, 3}, 0.7, {0.1, 0.2, 0.3}) *
                        Affine::scale({1.5, 1.5, 1.5});
    for (const Shape& s : shapes()) {
      for (const bool turned : {false, true}) {
        CAPTURE(s.name);
        CAPTURE(turned);
        const SolidPointer solid = turned ? transformed(s.solid, turn) : s.solid;
        // A domain that cuts nothing but a plane's thickness: forces the quadrature.
        Box cut = solid->bounding_box();
        cut.max[2] = cut.min[2] + (1 - 1e-12) * cut.length(2);
        bool exact = true;
        const VolumeMoments m = moments_in(*solid, Frame::cartesian_3d, cut, &exact);
        CHECK_FALSE(exact);
        const VolumeMoments e = moments_in(*solid, Frame::cartesian_3d, everywhere, &exact);
        CHECK(exact);
        CHECK(std::abs(m.volume / e.volume - 1) < 2e-4);
        const double l = size_of(*solid);
        for (std::size_t a = 0; a < 3; ++a) {
          CHECK(std::abs(m.centroid()[a] - e.centroid()[a]) < 2e-4 * l);
          CHECK(std::abs(m.inertia()[a] - e.inertia()[a]) < 2e-4 * e.volume * l * l);
          CHECK(std::abs(m.inertia()[a + 3] - e.inertia()[a + 3]) < 2e-4 * e.volume * l * l);
        }
      }
    }
  }

  TEST_CASE("shapes: spans never contradict membership, on any line") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> u(-1, 1);
    for (const Shape& s : shapes()) {
      CAPTURE(s.name);
      const Box b = s.solid->bounding_box();
      Spans found;
      long wrong = 0, hits = 0;
      for (int n = 0; n < 3000; ++n) {
        Vector3 a{}, d{u(random), u(random), u(random)};
        if (n % 5 == 0) d = {0, 0, 1};
        for (std::size_t k = 0; k < 3; ++k) {
          a[k] = b.middle(static_cast<int>(k)) + 0.55 * (b.max[k] - b.min[k]) * u(random);
        }
        const Line line{a, d};
        s.solid->spans(line, found);
        for (int k = 0; k < 5; ++k) {
          const double t = 3 * u(random);
          const bool in = std::any_of(found.begin(), found.end(),
                                      [t](const Span& p) { return p.low < t && t < p.high; });
          const Vector3 p = line.at(t);
          hits += in;
          wrong += in != s.solid->contains(p[0], p[1], p[2]);
        }
        for (const Span& p : found) {
          const Vector3 q = line.at(0.5 * (p.low + p.high));
          for (std::size_t k = 0; k < 3; ++k) {
            wrong += q[k] < b.min[k] - 1e-9 || q[k] > b.max[k] + 1e-9;
          }
        }
      }
      CHECK(wrong == 0);
      CHECK(hits > 300);
    }
  }

  TEST_CASE("shapes: points have the body's mass within 0.1 % at any resolution, and lie in it") {
    const Affine turn = Affine::rotate({1, 2, 3}, 0.7);
    double worst_of_all = 0;
    for (const Shape& s : shapes()) {
      for (const bool turned : {false, true}) {
        const SolidPointer solid = turned ? transformed(s.solid, turn) : s.solid;
        double worst = 0;
        long outside = 0;
        for (const double cell : {2.3, 1.1, 0.53, 0.4}) {
          LatticeOptions options;
          options.cell = cell;
          options.origin = {0.13, 0.07, 0.21};
          double sum = 0;
          for (const SeedPoint& p : fill(*solid, Frame::cartesian_3d, options, everywhere)) {
            sum += p.measure;
            outside += !solid->contains(Frame::cartesian_3d, p.x);
          }
          worst = std::max(worst, std::abs(sum / s.volume - 1));
        }
        CAPTURE(s.name);
        CAPTURE(turned);
        CHECK(worst < 1e-3);
        CHECK(outside == 0);
        worst_of_all = std::max(worst_of_all, worst);
      }
    }
    MESSAGE("greatest error of the mass: " << worst_of_all);
  }

  TEST_CASE("shapes: in the axisymmetric frame, to round-off of the quadrature") {
    for (const Shape& s : shapes()) {
      if (s.name == "hexagon extruded") {
        CHECK_THROWS_AS(s.solid->require(Frame::axisymmetric), std::invalid_argument);
        continue;
      }
      CAPTURE(s.name);
      CHECK_NOTHROW(s.solid->require(Frame::axisymmetric));
      const double size = size_of(*s.solid);
      for (const double cell : {0.5 * size, 0.11 * size, 0.04 * size}) {
        LatticeOptions options;
        options.cell = cell;
        double sum = 0, z = 0;
        long outside = 0;
        for (const SeedPoint& p : fill(*s.solid, Frame::axisymmetric, options, everywhere)) {
          sum += p.measure, z += p.measure * p.x[1];
          outside += !s.solid->contains(Frame::axisymmetric, p.x);
        }
        CHECK(std::abs(sum / s.volume - 1) < 1e-6);
        CHECK(std::abs(z / sum - s.z) < 0.02 * cell);  // moved only where pulled inside
        CHECK(outside == 0);
      }
    }
  }
}
