// SPDX-License-Identifier: GPL-3.0-or-later
// Points of a body's own: per axis, in zones, fitted to the body; how thick a body is.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "geometry_cases.hpp"
#include "krater/core/parallel.hpp"
#include "krater/geometry/seeds/thickness.hpp"
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

double total(const std::vector<SeedPoint>& points) {
  double sum = 0;
  for (const SeedPoint& p : points) sum += p.measure;
  return sum;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("points: one to four per direction, each axis its own") {
    const BoxSolid block({{0, 0, 0}, {4, 4, 4}});
    for (int nx = 1; nx <= 4; ++nx) {
      for (int nz = 1; nz <= 4; ++nz) {
        LatticeOptions options = cells(1);
        options.points_per_direction = {nx, 2, nz};
        options.stagger = false;
        const auto points = fill(block, Frame::cartesian_3d, options, everywhere);
        CHECK(points.size() == static_cast<std::size_t>(64 * nx * 2 * nz));
        CHECK(total(points) == doctest::Approx(64));
        CHECK(points.front().half_width[0] == doctest::Approx(0.5 / nx));
        CHECK(points.front().half_width[2] == doctest::Approx(0.5 / nz));
      }
    }
  }

  TEST_CASE("points: zones of more points keep the mass and are where they were asked for") {
    const auto plate =
        make_boolean(Boolean::subtract, {std::make_shared<CylinderSolid>(10, 3, Vector3{0, 0, 0}),
                                         std::make_shared<SphereSolid>(1.3, Vector3{0, 0, 3})});
    const double volume = plate->part(Frame::axisymmetric, everywhere).measure;
    RefinedZone zone;
    zone.box = {{0, 0, 0}, {2.6, 3, 0}};
    zone.points_per_direction = {4, 4, 4};
    zone.falloff = 2;
    FillReport report;
    const auto points =
        fill_body(*plate, Frame::axisymmetric, cells(0.5), {zone}, everywhere, &report);
    CHECK(std::abs(total(points) / volume - 1) < 1e-6);
    CHECK(std::abs(report.measure_points / report.measure_exact - 1) < 1e-6);
    CHECK(report.count == points.size());
    std::map<int, std::array<double, 2>> range;  // of r, by points per direction
    for (const SeedPoint& p : points) {
      CHECK(plate->contains(Frame::axisymmetric, p.x));
      const int n = static_cast<int>(std::lround(0.25 / p.half_width[0]));
      const auto [at, is_new] = range.try_emplace(n, std::array{p.x[0], p.x[0]});
      at->second = {std::min(at->second[0], p.x[0]), std::max(at->second[1], p.x[0])};
    }
    CHECK(range.at(4)[1] > 2.9);  // out to the next node, 3
    CHECK(range.at(4)[1] < 3.01);
    CHECK(range.at(2)[0] > 3.99);  // after a belt of 3 per direction, 2 cells wide
    // In 3D, with two zones that overlap.
    RefinedZone space = zone, other = zone;
    space.box = {{-2, -2, 1}, {2, 2, 3}};
    other.box = {{0, 0, 0}, {4, 4, 4}};
    other.points_per_direction = {3, 3, 3};
    const auto solid = fill_body(*plate, Frame::cartesian_3d, cells(1), {space, other}, everywhere);
    CHECK(std::abs(total(solid) / volume - 1) < 1e-4);
    CHECK(solid.size() > fill(*plate, Frame::cartesian_3d, cells(1), everywhere).size() * 5 / 4);
  }

  TEST_CASE("points: the sides of zones leave no light points, the mass stays") {
    for (const double offset : {0.0, 0.13, 0.31, 0.47}) {
      const auto nose = transformed(make_ogive(1, 6, 3), Affine::move({0, 0, offset}));
      RefinedZone zone;
      zone.box = {{0, 3, 0}, {0.6, 7, 0}};
      zone.points_per_direction = {4, 4, 4};
      zone.falloff = 1;
      const auto points = fill_body(*nose, Frame::axisymmetric, cells(0.25), {zone}, everywhere);
      double least = 9;
      for (const SeedPoint& p : points) {
        least = std::min(least, p.measure / (2 * pi * p.x[0]) / (0.0625 * 0.0625));
        CHECK(nose->contains(Frame::axisymmetric, p.x));
      }
      CHECK(least > 0.2);  // without the rule 0.007
      CHECK(std::abs(total(points) / nose->moments()->volume - 1) < 1e-6);
    }
  }

  TEST_CASE("points: a lattice fitted to the body makes whole cells, also of a turned one") {
    LatticeOptions options = cells(0.7);
    options.fit_to_body = true;
    options.stagger = false;
    const auto block = std::make_shared<BoxSolid>(Box{{0.1, 0.2, 0.3}, {2.1, 3.2, 4.3}});
    const auto straight = fill_body(*block, Frame::cartesian_3d, options, {}, everywhere);
    CHECK(straight.size() == 6 * 9 * 11);
    for (const SeedPoint& p : straight) CHECK(p.measure == doctest::Approx(24.0 / 594));
    const Affine turn =
        Affine::move({5, 0, 1}) * Affine::rotate({1, 1, 1}, 0.6) * Affine::scale({0.5, 0.5, 0.5});
    const auto turned = transformed(block, turn);
    options.cell = 0.35;
    FillReport report;
    const auto points = fill_body(*turned, Frame::cartesian_3d, options, {}, everywhere, &report);
    REQUIRE(points.size() == straight.size());
    CHECK(report.measure_points == doctest::Approx(3));
    for (std::size_t n = 0; n < points.size(); ++n) {
      const Vector3 x = turn.apply(straight[n].x);
      for (std::size_t k = 0; k < 3; ++k) CHECK(points[n].x[k] == doctest::Approx(x[k]));
      CHECK(turned->contains(Frame::cartesian_3d, points[n].x));
    }
    // A boolean that was turned as a whole knows its own axes too.
    const auto bored = transformed(
        make_boolean(Boolean::subtract,
                     {block, std::make_shared<CylinderSolid>(0.5, 9, Vector3{1.1, 1.7, 0})}),
        turn);
    const auto holed = fill_body(*bored, Frame::cartesian_3d, options, {}, everywhere);
    CHECK(holed.size() < points.size());
    CHECK(total(holed) == doctest::Approx((24 - pi * 0.25 * 4) / 8).epsilon(1e-3));
    CHECK_THROWS_AS(fill_body(*turned, Frame::cartesian_3d, options, {}, {{5, 0, 0}, {6, 6, 6}}),
                    std::invalid_argument);
    CHECK_THROWS_AS(fill_body(*make_slab(2, 0, inf), Frame::cartesian_3d, options, {}, everywhere),
                    std::invalid_argument);
    CHECK_THROWS_AS(fill_body(*block, Frame::cartesian_3d, options, {RefinedZone{}}, everywhere),
                    std::invalid_argument);
  }

  TEST_CASE("points: the same bits for any number of threads") {
    const auto solid = transformed(make_torus(3, 1), Affine::rotate({1, 0, 0}, 0.4));
    set_threads(1);
    const auto one = fill(*solid, Frame::cartesian_3d, cells(0.4), everywhere);
    set_threads(3);
    const auto three = fill(*solid, Frame::cartesian_3d, cells(0.4), everywhere);
    set_threads(1);
    REQUIRE(one.size() == three.size());
    CHECK(std::equal(one.begin(), one.end(), three.begin(), [](const auto& a, const auto& b) {
      return a.x == b.x && a.measure == b.measure && a.half_width == b.half_width;
    }));
  }

  TEST_CASE("thickness: of plates, tubes and balls; mirrors double it") {
    const auto thickness = [](const Solid& s, Frame frame, const Box& domain,
                              const MirrorSides& mirrors, double share) {
      return thickness_of_share(s, frame, fill(s, frame, cells(0.2), domain), domain, mirrors,
                                share);
    };
    const Box all{{-9, -9, -9}, {9, 9, 9}};
    const Box half{{0, -9, 0}, {9, 9, 9}};
    const BoxSolid plate({{-3, -3, -0.3}, {3, 3, 0.3}});
    const Frame full = Frame::cartesian_3d, axi = Frame::axisymmetric;
    CHECK(thickness(plate, full, all, {}, 0.2) == doctest::Approx(0.6));
    MirrorSides lower{};
    lower[2][0] = true;
    CHECK(thickness(plate, full, half, lower, 0.2) == doctest::Approx(0.6));
    CHECK(thickness(plate, full, half, {}, 0.2) == doctest::Approx(0.3));
    const auto tube = make_tube(2, 2.5, 6);
    CHECK(thickness(*tube, axi, {{0, -9, 0}, {9, 9, 0}}, {}, 0.2) == doctest::Approx(0.5));
    CHECK(thickness(*tube, full, all, {}, 0.02) < 0.55);
    const SphereSolid ball(2, {0, 0, 0});
    CHECK(thickness(ball, full, all, {}, 0.2) == doctest::Approx(0.442 * 4).epsilon(0.03));
    const CylinderSolid rod(1, 6, {0, 0, 0});
    CHECK(thickness(rod, axi, {{0, -9, 0}, {9, 9, 0}}, {}, 0.2) == doctest::Approx(2));
  }
}
