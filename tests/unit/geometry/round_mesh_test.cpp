// SPDX-License-Identifier: GPL-3.0-or-later
// O-grids: surfaces, volumes, quality, and where the domain may cut them.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "krater/geometry/meshes/round_mesh.hpp"
#include "krater/geometry/solids/primitives.hpp"
#include "krater/geometry/solids/shapes.hpp"
#include "krater/kinematics/mesh/mesh.hpp"

using namespace krater;

namespace {

constexpr double kPi = std::numbers::pi;
constexpr Halves kAll[] = {Halves::both, Halves::upper, Halves::lower};
constexpr Box kWide{{-100, -100, -100}, {100, 100, 100}};

double volume_of(const Mesh& mesh, bool axisymmetric = false) {
  const std::vector<double> parts = corner_volumes(mesh, axisymmetric);
  for (const double part : parts) REQUIRE(part > 0);
  return std::accumulate(parts.begin(), parts.end(), 0.0);
}

double share_of(Halves half) { return half == Halves::both ? 1 : 0.5; }

/// Elements along a quarter's inner block: the exposed edges of a quarter are 2 n on the circle.
int block_of(double radius, double element) {
  return std::max(1, static_cast<int>(std::lround(0.58 * radius / element)));
}

std::string message_of_mesh(const Solid& solid, Frame frame, const Box& domain) {
  try {
    round_mesh(solid, frame, domain, 0.25);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("round meshes: a disc's area is that of its polygon, in whole, halves and quarters") {
    for (const double element : {2.0, 0.6, 0.25, 0.1})
      for (const Halves first : kAll)
        for (const Halves second : kAll) {
          const Mesh mesh = disc_mesh(1, element, {first, second});
          const int n = block_of(1, element);
          const double whole = 4 * n * std::sin(kPi / (4 * n));  // 8 n triangles
          CHECK(volume_of(mesh) ==
                doctest::Approx(whole * share_of(first) * share_of(second)).epsilon(1e-13));
          std::size_t on_circle = 0;
          for (const MeshFace& edge : exposed_faces(mesh)) {
            const Vector3 &a = mesh.nodes[static_cast<std::size_t>(edge[0])],
                          &b = mesh.nodes[static_cast<std::size_t>(edge[1])];
            const bool cut = (first != Halves::both && a[0] == 0 && b[0] == 0) ||
                             (second != Halves::both && a[1] == 0 && b[1] == 0);
            if (cut) continue;
            ++on_circle;
            CHECK(std::hypot(a[0], a[1]) == doctest::Approx(1).epsilon(1e-15));
          }
          // No crack inside: only the circle is left.
          CHECK(on_circle == doctest::Approx(8 * n * share_of(first) * share_of(second)));
        }
  }

  TEST_CASE("round meshes: balls and cylinders lose volume with the square of the element") {
    const auto loss = [](double volume, double exact) { return 1 - volume / exact; };
    for (const int n : {4, 6}) {  // and twice as many
      const double ball = 4 * kPi / 3, rod = kPi * 2, element = 0.58 / n;
      const std::array<Halves, 3> both{};
      const double coarse = loss(volume_of(ball_mesh(1, 0.56 / n, both)), ball),
                   fine = loss(volume_of(ball_mesh(1, 0.28 / n, both)), ball);
      CHECK(coarse > 0);
      CHECK(coarse / fine == doctest::Approx(4).epsilon(0.05));
      const CylinderSolid cylinder{1, 2, {0, 0, 0}};
      const Frame frame = Frame::cartesian_3d;
      const double thick = loss(volume_of(round_mesh(cylinder, frame, kWide, element)), rod),
                   thin = loss(volume_of(round_mesh(cylinder, frame, kWide, element / 2)), rod);
      CHECK(thick / thin == doctest::Approx(4).epsilon(0.05));
      CHECK(thick == doctest::Approx(2.0 / 3 * std::pow(kPi / (8 * n), 2)).epsilon(0.02));
    }
  }

  TEST_CASE(
      "round meshes: no corner is worse than is said, and elements are about as large as asked") {
    for (const double element : {2.0, 1.0, 0.5, 0.25, 0.2, 0.1}) {
      const Mesh disc = disc_mesh(1, element, {}), ball = ball_mesh(1, element, {}),
                 ring = ring_mesh(0.5, 1, element, {});
      CHECK(mesh_quality(disc).least_jacobian > (block_of(1, element) == 1 ? 0.75 : 0.83));
      CHECK(mesh_quality(ball).least_jacobian > 0.65);
      // The coarsest ring has a quarter turn per element: its edges meet at 45 degrees.
      CHECK(mesh_quality(ring).least_jacobian > 0.7);
      if (element > 0.25) continue;
      for (const Mesh* mesh : {&disc, &ball}) {
        const MeshQuality quality = mesh_quality(*mesh);
        CHECK(quality.shortest > 0.6 * element);
        CHECK(quality.longest < 1.7 * element);
        const double each = volume_of(*mesh) / static_cast<double>(mesh->element_count());
        CHECK(std::pow(each, 1.0 / mesh->dimension) == doctest::Approx(element).epsilon(0.15));
      }
      CHECK(mesh_quality(ring).least_jacobian > 0.95);
    }
  }

  TEST_CASE("round meshes: shapes where they lie, along any axis, cut by their middle planes") {
    const Frame space = Frame::cartesian_3d;
    const int n = block_of(1, 0.3);
    const double facets = 3 * 4 * n * std::sin(kPi / (4 * n));
    for (int axis = 0; axis < 3; ++axis) {
      const CylinderSolid rod{1, 3, {1, 2, 3}, axis};
      const double whole = volume_of(round_mesh(rod, space, kWide, 0.3));
      CHECK(whole == doctest::Approx(facets).epsilon(1e-12));
      Box half = kWide;  // from the axis on, and the last third off
      const auto across = static_cast<std::size_t>((axis + 1) % 3),
                 along = static_cast<std::size_t>(axis);
      const Vector3 base{1, 2, 3};
      half.min[across] = base[across];
      half.max[along] = base[along] + 2;
      const Mesh mesh = round_mesh(rod, space, half, 0.3);
      CHECK(volume_of(mesh) == doctest::Approx(whole / 3).epsilon(1e-12));
      for (const Vector3& x : mesh.nodes) {
        CHECK(x[across] >= half.min[across]);
        CHECK(x[along] <= half.max[along] + 1e-15);
      }
    }
    const auto tube = transformed(make_tube(0.5, 1, 2), placing({0, 0, 5}, 2, true));
    CHECK(volume_of(round_mesh(*tube, space, kWide, 0.1)) ==
          doctest::Approx(1.5 * kPi).epsilon(0.01));
    const SphereSolid ball{1, {2, 0, 0}};
    Box eighth{{2, 0, -9}, {9, 9, 0}};
    CHECK(8 * volume_of(round_mesh(ball, space, eighth, 0.2)) ==
          doctest::Approx(volume_of(round_mesh(ball, space, kWide, 0.2))).epsilon(1e-12));
    const auto twice = transformed(std::make_shared<SphereSolid>(ball), Affine::scale({2, 2, 2}));
    CHECK(volume_of(round_mesh(*twice, space, kWide, 0.4)) ==
          doctest::Approx(8 * volume_of(round_mesh(ball, space, kWide, 0.2))).epsilon(1e-12));
    const auto askew = transformed(std::make_shared<CylinderSolid>(1.0, 3.0, Vector3{}),
                                   Affine::rotate({0, 1, 0}, 0.4));
    CHECK(volume_of(round_mesh(*askew, space, kWide, 0.3)) ==
          doctest::Approx(facets).epsilon(1e-12));
  }

  TEST_CASE("round meshes: sections of the plane frames") {
    const SphereSolid ball{1, {0, 0, 2}};
    const Box right{{0, -9, 0}, {9, 9, 0}};
    const Mesh half = round_mesh(ball, Frame::axisymmetric, right, 0.1);
    CHECK(volume_of(half, true) == doctest::Approx(4 * kPi / 3).epsilon(0.01));
    const Box above{{0, 2, 0}, {9, 9, 0}};
    CHECK(volume_of(round_mesh(ball, Frame::axisymmetric, above, 0.1), true) ==
          doctest::Approx(volume_of(half, true) / 2).epsilon(1e-12));
    const CylinderSolid across{1, 2, {3, -1, 4}, 1};
    const Mesh disc = round_mesh(across, Frame::plane_strain, kWide, 0.1);
    CHECK(volume_of(disc) == doctest::Approx(kPi).epsilon(0.01));
    for (const Vector3& x : disc.nodes) CHECK(std::hypot(x[0] - 3, x[1] - 4) < 1 + 1e-14);
    const auto ring = transformed(make_tube(0.5, 1, 2), placing({0, -1, 0}, 1));
    CHECK(volume_of(round_mesh(*ring, Frame::plane_strain, kWide, 0.1)) ==
          doctest::Approx(0.75 * kPi).epsilon(0.01));
  }

  TEST_CASE("round meshes: other cuts and other shapes are refused") {
    const CylinderSolid rod{1, 3, {0, 0, 0}};
    const Frame space = Frame::cartesian_3d;
    CHECK(
        message_of_mesh(rod, space, {{0.2, -9, -9}, {9, 9, 9}}).find("side x_min of the domain") !=
        std::string::npos);
    CHECK(message_of_mesh(rod, space, {{-0.5, -9, -9}, {0.5, 9, 9}}).find("through its middle") !=
          std::string::npos);
    const auto askew = transformed(std::make_shared<CylinderSolid>(1.0, 3.0, Vector3{}),
                                   Affine::rotate({0, 1, 0}, 0.4));
    CHECK(message_of_mesh(*askew, space, {{-9, -9, 0}, {9, 9, 9}}).find("askew") !=
          std::string::npos);
    CHECK(message_of_mesh(*make_cone(1, 0, 2), space, kWide).find("no mesh of its own") !=
          std::string::npos);
    CHECK(message_of_mesh(*make_ellipsoid({1, 1, 2}), space, kWide).find("no mesh of its own") !=
          std::string::npos);
    CHECK_THROWS_AS(round_mesh(rod, space, kWide, 1e-5), std::invalid_argument);
  }
}
