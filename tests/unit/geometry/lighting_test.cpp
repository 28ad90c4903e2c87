// SPDX-License-Identifier: GPL-3.0-or-later
// Lighting times of a detonation: straight where the source is in sight, about corners, from one
// explosive into another, from lines and planes.
#include <doctest/doctest.h>

#include <cmath>
#include <memory>

#include "krater/geometry/lighting.hpp"
#include "krater/geometry/solids/csg.hpp"
#include "krater/geometry/solids/primitives.hpp"

namespace {

using namespace krater;

constexpr double kSpeed = 7000;
const Box kDomain{{-1, -1, -1}, {1, 1, 1}};

std::shared_ptr<const Solid> box(std::array<double, 3> min, std::array<double, 3> max) {
  return std::make_shared<BoxSolid>(Box{min, max});
}
Detonator at_point(double x, double z, double time = 0) {
  return {"d", "", Detonator::Kind::point, {x, z, 0}, {}, time};
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("lighting: in sight of a point the time is the distance over D, to round-off") {
    const auto charge = box({0, -1, 0}, {0.2, 1, 0.5});
    const Lighting light{
        Frame::plane_strain, kDomain, 0.01, {{charge.get(), kSpeed}}, {at_point(0, 0, 3e-6)}};
    CHECK(light.idle().empty());
    for (double x = 0.003; x < 0.2; x += 0.0171)
      for (double z = 0.004; z < 0.5; z += 0.0233)
        CHECK(light.at(0, {x, z, 0}) ==
              doctest::Approx(3e-6 + std::hypot(x, z) / kSpeed).epsilon(1e-12));
  }

  TEST_CASE("lighting: about an obstacle the shortest path, to half a spacing at its corners") {
    // A wall from the floor to z = 0.3 between source and target: over its two upper corners.
    const auto charge = make_boolean(
        Boolean::subtract, {box({0, -1, 0}, {0.6, 1, 0.5}), box({0.28, -1, -1}, {0.32, 1, 0.3})});
    for (const double spacing : {0.01, 0.005}) {
      const Lighting light{
          Frame::plane_strain, kDomain, spacing, {{charge.get(), kSpeed}}, {at_point(0.1, 0.05)}};
      for (const double z : {0.05, 0.15, 0.29}) {
        const double exact = std::hypot(0.18, 0.25) + 0.04 + std::hypot(0.18, 0.3 - z);
        const double path = light.at(0, {0.5, z, 0}) * kSpeed;
        CAPTURE(spacing);
        CAPTURE(z);
        CHECK(path > exact - 1.5 * spacing);
        CHECK(path < exact + 1.5 * spacing);
        CHECK(path > std::hypot(0.4, z - 0.05) + 0.05);  // the straight line is barred
      }
    }
  }

  TEST_CASE("lighting: lines, planes, the earlier of two, and a second explosive") {
    const auto slow = box({0, -1, 0}, {0.2, 1, 0.2}), fast = box({0, -1, 0.2}, {0.2, 1, 0.4});
    const Detonator plane{"p", "", Detonator::Kind::plane, {0, 0, 0}, {0, 1, 0}, 0};
    const Lighting light{
        Frame::plane_strain, kDomain, 0.01, {{slow.get(), 4000}, {fast.get(), 8000}}, {plane}};
    CHECK(light.at(0, {0.11, 0.13, 0}) == doctest::Approx(0.13 / 4000).epsilon(1e-12));
    CHECK(light.at(1, {0.11, 0.35, 0}) == doctest::Approx(0.2 / 4000 + 0.15 / 8000).epsilon(1e-3));
    const Detonator line{"l", "", Detonator::Kind::line, {0.05, 0.1, 0}, {0.15, 0.1, 0}, 0};
    const Lighting two{
        Frame::plane_strain, kDomain, 0.01, {{slow.get(), 4000}}, {line, at_point(0, 0, 1)}};
    CHECK(two.at(0, {0.1, 0.17, 0}) == doctest::Approx(0.07 / 4000).epsilon(1e-12));
    CHECK(two.at(0, {0.18, 0.14, 0}) ==
          doctest::Approx(std::hypot(0.03, 0.04) / 4000).epsilon(1e-12));
  }

  TEST_CASE("lighting: what no explosive joins to a source stays dark; a source outside is idle") {
    const auto near = box({0, -1, 0}, {0.2, 1, 0.2}), far = box({0, -1, 0.3}, {0.2, 1, 0.5});
    const Lighting light{Frame::plane_strain,
                         kDomain,
                         0.01,
                         {{near.get(), kSpeed}, {far.get(), kSpeed}},
                         {at_point(0.1, 0.1), at_point(0.1, 0.25)}};
    CHECK(std::isfinite(light.at(0, {0.1, 0.15, 0})));
    CHECK_FALSE(std::isfinite(light.at(1, {0.1, 0.35, 0})));
    REQUIRE(light.idle().size() == 1);
    CHECK(light.idle()[0] == 1);
  }

  TEST_CASE("lighting: in space and about the axis") {
    const auto ball = box({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1});
    Detonator centre;
    const Lighting space{Frame::cartesian_3d, kDomain, 0.02, {{ball.get(), kSpeed}}, {centre}};
    CHECK(space.at(0, {0.05, -0.07, 0.02}) ==
          doctest::Approx(std::sqrt(0.0025 + 0.0049 + 0.0004) / kSpeed).epsilon(1e-12));
    const Lighting axis{Frame::axisymmetric,
                        Box{{0, -1, 0}, {1, 1, 0}},
                        0.01,
                        {{ball.get(), kSpeed}},
                        {at_point(0, -0.1)}};
    CHECK(axis.at(0, {0.06, 0.05, 0}) ==
          doctest::Approx(std::hypot(0.06, 0.15) / kSpeed).epsilon(1e-12));
  }
}
