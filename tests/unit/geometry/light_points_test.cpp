// SPDX-License-Identifier: GPL-3.0-or-later
// No seed far lighter than its neighbours; a staggered lattice that is its own mirror image.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "geometry_cases.hpp"
#include "krater/geometry/solids/csg.hpp"
#include "krater/geometry/solids/shapes.hpp"

using namespace krater;
using namespace krater::test;

namespace {

LatticeOptions cells(double cell) {
  LatticeOptions options;
  options.cell = cell;
  return options;
}

double measure_of(const std::vector<SeedPoint>& points) {
  double sum = 0;
  for (const SeedPoint& p : points) sum += p.measure;
  return sum;
}

/// Volume of the lightest point over that of a whole cell; at the axis over the ring's there.
double lightest(const std::vector<SeedPoint>& points, Frame frame, double s) {
  double least = 1e300;
  for (const SeedPoint& p : points) {
    const double whole = frame == Frame::axisymmetric   ? 2 * pi * std::max(p.x[0], s / 2) * s * s
                         : frame == Frame::plane_strain ? s * s
                                                        : s * s * s;
    least = std::min(least, p.measure / whole);
  }
  return least;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("points: tips, edges and slivers leave no light point, in any frame") {
    for (const Frame frame : {Frame::axisymmetric, Frame::plane_strain, Frame::cartesian_3d}) {
      for (const double radius : {0.2, 1.0, 4.0}) {
        for (const double offset : {0.0, 0.21, 0.5}) {
          CAPTURE(static_cast<int>(frame));
          CAPTURE(radius);
          CAPTURE(offset);
          const double cell = frame == Frame::cartesian_3d ? 1 : 0.5;
          const auto cone = transformed(make_cone(radius, 0, 6), Affine::move({0, 0, offset}));
          const auto ball = std::make_shared<SphereSolid>(3, Vector3{0, 0, offset});
          const auto other = std::make_shared<SphereSolid>(3, Vector3{0, 0, offset + radius});
          const auto crescent = make_boolean(Boolean::subtract, {ball, other});
          for (const std::shared_ptr<const Solid>& solid : {cone, crescent}) {
            FillReport report;
            const auto points = fill(*solid, frame, cells(cell), everywhere, &report);
            const double exact = solid->measure(frame, everywhere);
            const double thickness = solid == cone ? radius : radius / 2;
            CHECK(measure_of(points) == doctest::Approx(exact).epsilon(2e-3));
            CHECK(report.count == points.size());
            // What is thinner than a spacing all over has light points only.
            if (thickness >= cell) CHECK(lightest(points, frame, cell / 2) > 0.2);
          }
        }
      }
    }
  }

  TEST_CASE("points: what a tip gives away keeps mass and centroid") {
    const auto tip = make_cone(1, 0, 8);
    for (const Frame frame : {Frame::axisymmetric, Frame::cartesian_3d}) {
      const auto points = fill(*tip, frame, cells(0.5), everywhere);
      double z = 0, mass = 0;
      const std::size_t k = frame == Frame::axisymmetric ? 1 : 2;
      for (const SeedPoint& p : points) {
        z += p.measure * p.x[k];
        mass += p.measure;
        CHECK(tip->contains(frame, p.x));
      }
      CHECK(mass == doctest::Approx(8 * pi / 3).epsilon(1e-3));
      CHECK(z / mass == doctest::Approx(2.0).epsilon(1e-3));
    }
  }

  TEST_CASE("points: a needle's axis leaves no traces") {
    for (const double radius : {0.1, 0.2, 0.4}) {
      for (const double offset : {0.0, 0.13, 0.5}) {
        const auto needle = transformed(make_cone(radius, 0, 8), Affine::move({0, 0, offset}));
        const auto points = fill(*needle, Frame::axisymmetric, cells(0.4), everywhere);
        std::vector<double> masses;
        for (const SeedPoint& p : points) masses.push_back(p.measure);
        std::sort(masses.begin(), masses.end());
        CHECK(masses.front() > 0.01 * masses[masses.size() / 2]);
        CHECK(measure_of(points) == doctest::Approx(8 * pi / 3 * radius * radius).epsilon(1e-6));
      }
    }
  }

  TEST_CASE("points: a foil thinner than a spacing keeps its points") {
    const BoxSolid foil({{0, 0, 0.01}, {4, 4, 0.03}});  // 0.04 of a spacing of 0.5
    for (const Frame frame : {Frame::plane_strain, Frame::cartesian_3d}) {
      LatticeOptions options = cells(1);
      options.stagger = false;
      const auto points = fill(foil, frame, options, everywhere);
      CHECK(points.size() == (frame == Frame::cartesian_3d ? 64U : 8U));
    }
  }

  TEST_CASE("points: jitter leaves rings away from the axis") {
    const CylinderSolid rod(3, 8, {0, 0, 0});
    LatticeOptions options = cells(1);
    options.jitter = 0.9;
    for (options.seed = 0; options.seed < 40; ++options.seed)
      for (const SeedPoint& p : fill(rod, Frame::axisymmetric, options, everywhere))
        CHECK(p.x[0] > 0.12);
  }

  TEST_CASE("lattice: staggered columns counted from a plane are their own mirror image") {
    const auto ball = std::make_shared<SphereSolid>(2.6, Vector3{1.5, 1.5, 0.2});
    const auto block = std::make_shared<BoxSolid>(Box{{-2, -1.75, -3}, {5, 4.75, 0}});
    for (const Frame frame : {Frame::plane_strain, Frame::cartesian_3d}) {
      for (const int n : {1, 2, 3}) {
        for (const std::shared_ptr<const Solid>& solid :
             {std::shared_ptr<const Solid>{ball}, std::shared_ptr<const Solid>{block}}) {
          LatticeOptions options = cells(0.5);
          options.points_per_direction = {n, n, n};
          options.origin = {-8, -9, -7};  // the plane is an odd number of columns away for n = 1, 3
          options.mirror = {1.5, 1.5};
          using Key = std::tuple<long, long, long, long>;
          const auto key = [](double x, double y, double z, double m) {
            return Key{std::lround(1e9 * x), std::lround(1e9 * y), std::lround(1e9 * z),
                       std::lround(1e9 * m)};
          };
          std::multiset<Key> here, across, turned;
          for (const SeedPoint& p : fill(*solid, frame, options, everywhere)) {
            here.insert(key(p.x[0], p.x[1], p.x[2], p.measure));
            across.insert(key(3 - p.x[0], p.x[1], p.x[2], p.measure));
            turned.insert(key(p.x[0], 3 - p.x[1], p.x[2], p.measure));
          }
          CHECK(here == across);
          if (frame == Frame::cartesian_3d) CHECK(here == turned);
        }
      }
    }
  }
}
