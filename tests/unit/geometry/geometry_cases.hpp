// SPDX-License-Identifier: GPL-3.0-or-later
// Solids in frames and domains with contents known in closed form, shared by the geometry tests.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "krater/geometry/seeds/lattice.hpp"
#include "krater/geometry/solids/primitives.hpp"

namespace krater::test {

inline constexpr double pi = std::numbers::pi;
inline constexpr double inf = std::numeric_limits<double>::infinity();
inline const Box everywhere{{-inf, -inf, -inf}, {inf, inf, inf}};

struct Case {
  std::string name;
  std::shared_ptr<const Solid> solid;
  Frame frame;
  Box domain;
  double measure;
  std::array<double, 3> centroid;  ///< weighted with the measure, grid axes
};

inline std::vector<Case> exact_cases() {
  const Frame axi = Frame::axisymmetric, plane = Frame::plane_strain, full = Frame::cartesian_3d;
  const double r = 3.81e-3, h = 25.4e-3, a = 5e-3;
  const double c = 4 * r / (3 * pi);  // centroid of a half disc
  const auto rod = std::make_shared<CylinderSolid>(r, h, std::array<double, 3>{0, 0, 0});
  const auto rod_x =
      std::make_shared<CylinderSolid>(r, h, std::array<double, 3>{1e-3, 2e-3, 3e-3}, 0);
  const auto disc_y =
      std::make_shared<CylinderSolid>(r, h, std::array<double, 3>{1e-3, -h / 2, 3e-3}, 1);
  const auto ball = std::make_shared<SphereSolid>(a, std::array<double, 3>{0, 0, 6e-3});
  const auto block = std::make_shared<BoxSolid>(Box{{-1e-3, -2e-3, 0.5e-3}, {4e-3, 5e-3, 9e-3}});
  const Box quarter{{0, 0, -inf}, {inf, inf, inf}};
  const Box eighth{{0, 0, 6e-3}, {inf, inf, inf}};
  const Box right_half{{0, -inf, -inf}, {inf, inf, inf}};
  const Box upper{{-inf, 6e-3, 0}, {inf, inf, 0}};  // 2D: z >= centre of the ball
  const double vc = pi * r * r * h, vs = 4 * pi / 3 * a * a * a;
  const double half_x =
      std::sqrt(r * r - 4e-6);  // half width of rod_x cut at y = 0, 2 mm off its axis
  return {
      {"rod axi", rod, axi, everywhere, vc, {2 * r / 3, h / 2, 0}},
      {"rod plane", rod, plane, everywhere, 2 * r * h, {0, h / 2, 0}},
      {"rod half plane", rod, plane, right_half, r * h, {r / 2, h / 2, 0}},
      {"rod 3d", rod, full, everywhere, vc, {0, 0, h / 2}},
      {"rod quarter", rod, full, quarter, vc / 4, {c, c, h / 2}},
      {"rod along x 3d", rod_x, full, everywhere, vc, {1e-3 + h / 2, 2e-3, 3e-3}},
      {"rod along x plane", rod_x, plane, everywhere, 2 * half_x * h, {1e-3 + h / 2, 3e-3, 0}},
      {"rod along y 3d", disc_y, full, everywhere, vc, {1e-3, 0, 3e-3}},
      {"rod along y plane", disc_y, plane, everywhere, pi * r * r, {1e-3, 3e-3, 0}},
      {"ball axi", ball, axi, everywhere, vs, {3 * pi * a / 16, 6e-3, 0}},
      {"ball upper axi", ball, axi, upper, vs / 2, {3 * pi * a / 16, 6e-3 + 3 * a / 8, 0}},
      {"ball plane", ball, plane, everywhere, pi * a * a, {0, 6e-3, 0}},
      {"ball half plane", ball, plane, right_half, pi * a * a / 2, {4 * a / (3 * pi), 6e-3, 0}},
      {"ball 3d", ball, full, everywhere, vs, {0, 0, 6e-3}},
      {"ball quarter", ball, full, quarter, vs / 4, {3 * a / 8, 3 * a / 8, 6e-3}},
      {"ball eighth", ball, full, eighth, vs / 8, {3 * a / 8, 3 * a / 8, 6e-3 + 3 * a / 8}},
      {"block plane", block, plane, everywhere, 5e-3 * 8.5e-3, {1.5e-3, 4.75e-3, 0}},
      {"block 3d", block, full, everywhere, 5e-3 * 7e-3 * 8.5e-3, {1.5e-3, 1.5e-3, 4.75e-3}},
      {"block quarter", block, full, quarter, 4e-3 * 5e-3 * 8.5e-3, {2e-3, 2.5e-3, 4.75e-3}},
  };
}

}  // namespace krater::test
