// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
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

SolidPointer ball(double radius, Vector3 at) { return std::make_shared<SphereSolid>(radius, at); }

/// Two balls of radius 1, a distance d apart, share two caps of height 1 - d/2.
double lens(double d) {
  const double h = 1 - d / 2;
  return 2 * pi * h * h * (3 - h) / 3;
}

struct Case3 {
  const char* name;
  SolidPointer solid;
  double volume;
  Vector3 centroid;
};

std::vector<Case3> boolean_cases() {
  const double v = 4 * pi / 3, d = 0.8, l = lens(d);
  const SolidPointer a = ball(1, {0, 0, 0}), b = ball(1, {d, 0, 0});
  const SolidPointer box = std::make_shared<BoxSolid>(Box{{-2, -2, -2}, {2, 2, 2}});
  const SolidPointer hole = std::make_shared<CylinderSolid>(0.7, 10, Vector3{0, 0, -5});
  const SolidPointer cross = std::make_shared<CylinderSolid>(0.7, 10, Vector3{-5, 0, 0}, 0);
  const double steinmetz = 16.0 / 3 * 0.343;  // two equal cylinders at right angles: 16 r^3/3
  const double bored = pi * 0.49 * 4;
  return {
      {"union of balls", make_boolean(Boolean::unite, {a, b}), 2 * v - l, {d / 2, 0, 0}},
      {"intersection of balls", make_boolean(Boolean::intersect, {a, b}), l, {d / 2, 0, 0}},
      {"difference of balls",
       make_boolean(Boolean::subtract, {a, b}),
       v - l,
       {-d / 2 * l / (v - l), 0, 0}},
      {"crossing cylinders", make_boolean(Boolean::intersect, {hole, cross}), steinmetz, {0, 0, 0}},
      {"box bored twice",
       make_boolean(Boolean::subtract, {box, hole, cross}),
       64 - 2 * bored + steinmetz,
       {0, 0, 0}},
      {"shell",
       make_boolean(Boolean::subtract, {ball(1, {0.1, 0, 0}), ball(0.9, {0.1, 0, 0})}),
       v * (1 - 0.729),
       {0.1, 0, 0}},
      {"ball above a slab",
       make_boolean(Boolean::intersect, {a, make_slab(2, 0, inf)}),
       v / 2,
       {0, 0, 0.375}},
  };
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("csg: operations on spans") {
    const Spans a{{0, 2}, {3, 5}}, b{{1, 4}, {5, 6}};
    Spans out;
    const auto is = [&out](const Spans& wanted) {
      return std::equal(
          out.begin(), out.end(), wanted.begin(), wanted.end(),
          [](const Span& p, const Span& q) { return p.low == q.low && p.high == q.high; });
    };
    combine(SetOperation::unite, a, b, out);
    CHECK(is({{0, 6}}));
    combine(SetOperation::intersect, a, b, out);
    CHECK(is({{1, 2}, {3, 4}}));
    combine(SetOperation::subtract, a, b, out);
    CHECK(is({{0, 1}, {4, 5}}));
    combine(SetOperation::subtract, a, {}, out);
    CHECK(is(a));
    combine(SetOperation::subtract, a, a, out);
    CHECK(out.empty());
    combine(SetOperation::intersect, a, {{-inf, inf}}, out);
    CHECK(is(a));
  }

  TEST_CASE("csg: volumes and centroids of booleans, by quadrature and by points") {
    const Affine turn = Affine::rotate({1, -1, 2}, 1.1) * Affine::scale({2, 2, 2});
    for (const Case3& c : boolean_cases()) {
      for (const bool turned : {false, true}) {
        CAPTURE(c.name);
        CAPTURE(turned);
        const SolidPointer s = turned ? transformed(c.solid, turn) : c.solid;
        const double volume = turned ? 8 * c.volume : c.volume;
        const Vector3 centroid = turned ? turn.apply(c.centroid) : c.centroid;
        const VolumeMoments m = moments_in(*s, Frame::cartesian_3d, everywhere);
        CHECK(std::abs(m.volume / volume - 1) < 2e-4);
        for (std::size_t k = 0; k < 3; ++k) {
          CHECK(std::abs(m.centroid()[k] - centroid[k]) < 1e-3);
        }
        for (const double cell : {0.9, 0.41, 0.17}) {
          LatticeOptions options;
          options.cell = turned ? 2 * cell : cell;
          double sum = 0;
          long outside = 0;
          for (const SeedPoint& p : fill(*s, Frame::cartesian_3d, options, everywhere)) {
            sum += p.measure;
            outside += !s->contains(Frame::cartesian_3d, p.x);
          }
          CAPTURE(cell);
          CHECK(std::abs(sum / volume - 1) < 1e-3);
          CHECK(outside == 0);
        }
      }
    }
  }

  TEST_CASE("csg: inertia of the points converges at second order to the solid's") {
    const std::vector<SolidPointer> solids{
        make_boolean(Boolean::subtract, {ball(1, {0, 0, 0}), ball(0.6, {0, 0, 0.2})}),
        make_ogive(0.4, 2, 3), make_torus(1, 0.4), make_ellipsoid({1, 0.7, 0.5})};
    for (const SolidPointer& s : solids) {
      const VolumeMoments e = moments_in(*s, Frame::cartesian_3d, everywhere);
      double error[3];
      int level = 0;
      for (const double cell : {0.4, 0.2, 0.1}) {
        LatticeOptions options;
        options.cell = cell;
        const auto points = fill(*s, Frame::cartesian_3d, options, everywhere);
        const VolumeMoments p = moments_of(points, Frame::cartesian_3d);
        error[level++] = std::abs(p.inertia()[0] / e.inertia()[0] - 1);
      }
      const double order = std::log2(error[0] / error[2]) / 2;
      MESSAGE("inertia: errors " << error[0] << " " << error[1] << " " << error[2] << ", order "
                                 << order);
      CHECK(order > 1.6);
      CHECK(order < 2.6);
      CHECK(error[2] < 0.01);
    }
  }

  TEST_CASE("csg: axisymmetric and plane sections of booleans") {
    const auto shell = make_boolean(Boolean::subtract, {ball(1, {0, 0, 0}), ball(0.9, {0, 0, 0})});
    CHECK_NOTHROW(shell->require(Frame::axisymmetric));
    CHECK_THROWS_AS(
        make_boolean(Boolean::unite, {shell, ball(1, {1, 0, 0})})->require(Frame::axisymmetric),
        std::invalid_argument);
    CHECK_NOTHROW(
        transformed(shell, Affine::rotate({0, 1, 0}, pi / 2))->require(Frame::axisymmetric));
    const auto lying = make_cone(1, 0, 2);
    CHECK_THROWS_AS(
        transformed(lying, Affine::rotate({0, 1, 0}, pi / 2))->require(Frame::axisymmetric),
        std::invalid_argument);
    CHECK_NOTHROW(transformed(lying, Affine::rotate({0, 1, 0}, pi))->require(Frame::axisymmetric));
    CHECK_NOTHROW(transformed(lying, Affine::scale({2, 2, 1}))->require(Frame::axisymmetric));
    CHECK_THROWS_AS(transformed(lying, Affine::scale({2, 1, 1}))->require(Frame::axisymmetric),
                    std::invalid_argument);
    for (const double cell : {0.5, 0.11, 0.03}) {
      LatticeOptions options;
      options.cell = cell;
      double axi = 0, plane = 0;
      for (const auto& p : fill(*shell, Frame::axisymmetric, options, everywhere)) axi += p.measure;
      for (const auto& p : fill(*shell, Frame::plane_strain, options, everywhere))
        plane += p.measure;
      CHECK(std::abs(axi / (4 * pi / 3 * (1 - 0.729)) - 1) < 1e-6);
      CHECK(std::abs(plane / (pi * (1 - 0.81)) - 1) < 1e-6);
    }
  }

  TEST_CASE("csg: moments, bounds and nesting survive maps") {
    const Affine map =
        Affine::move({1, 2, 3}) * Affine::rotate({0, 1, 1}, 0.3) * Affine::scale({1, 2, 3});
    const SphereSolid sphere(1, {0, 0, 0});
    const auto image = transformed(std::make_shared<SphereSolid>(sphere), map);
    const VolumeMoments m = *image->moments();
    CHECK(m.volume == doctest::Approx(6 * 4 * pi / 3));
    // Bounds of an ellipsoid: the lengths of the rows of L.
    const Box box = image->bounding_box();
    for (std::size_t k = 0; k < 3; ++k) {
      const double row = std::sqrt(map.linear[3 * k] * map.linear[3 * k] +
                                   map.linear[3 * k + 1] * map.linear[3 * k + 1] +
                                   map.linear[3 * k + 2] * map.linear[3 * k + 2]);
      CHECK(box.max[k] == doctest::Approx(map.shift[k] + row));
      CHECK(box.min[k] == doctest::Approx(map.shift[k] - row));
    }
    const auto back = transformed(image, map.inverse());
    std::mt19937 random(4);
    std::uniform_real_distribution<double> u(-1.2, 1.2);
    for (int n = 0; n < 500; ++n) {
      const double x = u(random), y = u(random), z = u(random);
      CHECK(back->contains(x, y, z) == sphere.contains(x, y, z));
    }
    CHECK_THROWS_AS(Affine::scale({1, 0, 1}), std::invalid_argument);
    CHECK_THROWS_AS(Affine::rotate({0, 0, 0}, 1), std::invalid_argument);
    CHECK_THROWS_AS(make_boolean(Boolean::unite, {image}), std::invalid_argument);
    CHECK_THROWS_AS(make_boolean(Boolean::unite, {image, nullptr}), std::invalid_argument);
  }

  TEST_CASE("shapes: what is no solid is refused with a reason") {
    CHECK_THROWS_AS(make_tube(2, 1, 1), std::invalid_argument);
    CHECK_THROWS_AS(make_cone(0, 0, 1), std::invalid_argument);
    CHECK_THROWS_AS(make_torus(1, 1.5), std::invalid_argument);
    CHECK_THROWS_AS(make_ellipsoid({1, -1, 1}), std::invalid_argument);
    CHECK_THROWS_AS(make_ogive(1, 2, 3), std::invalid_argument);  // the nose is 3.3 long
    CHECK_THROWS_AS(make_ogive(1, 9, 0.4), std::invalid_argument);
    CHECK_THROWS_AS(make_slab(2, 1, 0), std::invalid_argument);
    CHECK_THROWS_AS(make_slab(2, -inf, inf), std::invalid_argument);
    CHECK_THROWS_AS(polygon_profile({{0, 0}, {1, 0}}), std::invalid_argument);
    CHECK_THROWS_AS(polygon_profile({{0, 0}, {1, 0}, {2, 0}}), std::invalid_argument);
    CHECK_THROWS_AS(polygon_profile({{0, 0}, {1, 1}, {1, 0}, {0, 1}}), std::invalid_argument);
    CHECK_THROWS_AS(polygon_profile({{0, 0}, {1, 0}, {1, 0}, {0, 1}}), std::invalid_argument);
    CHECK_THROWS_AS(polygon_profile({{0, 0}, {1, 0}, {std::nan(""), 1}}), std::invalid_argument);
    CHECK_THROWS_AS(make_revolution(polygon_profile({{-1, 0}, {1, 0}, {1, 1}})),
                    std::invalid_argument);
    CHECK_THROWS_AS(make_extrusion(polygon_profile({{0, 0}, {1, 0}, {1, 1}}), -1),
                    std::invalid_argument);
  }
}
