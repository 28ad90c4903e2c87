// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "geometry_cases.hpp"

using namespace krater;
using namespace krater::test;

namespace {

/// A solid that knows nothing but its spans along z: exercises the adaptive default.
class Ellipsoid final : public Solid {
 public:
  using Solid::contains;
  void spans(const Line& line, Spans& out) const override {
    const double x = line.origin[0], y = line.origin[1];
    const double rest = 1 - x * x / 4 - y * y / 2.25;
    out.clear();
    if (rest > 0) out.push_back({1 - std::sqrt(rest), 1 + std::sqrt(rest)});
  }
  Box bounding_box() const override { return {{-2, -1.5, 0}, {2, 1.5, 2}}; }
};

/// Sum of the clips of all cells of a lattice over the solid.
CellPart sum_of_clips(const Case& c, double s, double offset) {
  const Box box = intersection(c.solid->extent(c.frame), c.domain, dimension(c.frame));
  std::array<int, 3> n{1, 1, 1};
  std::array<double, 3> low{};
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension(c.frame)); ++a) {
    low[a] = (std::floor(box.min[a] / s) - 2 + offset * static_cast<double>(a + 1)) * s;
    n[a] = static_cast<int>(std::ceil((box.max[a] - low[a]) / s));
  }
  CellPart sum;
  for (int i = 0; i < n[0]; ++i) {
    for (int j = 0; j < n[1]; ++j) {
      for (int k = 0; k < n[2]; ++k) {
        const Box cell{{low[0] + i * s, low[1] + j * s, low[2] + k * s},
                       {low[0] + (i + 1) * s, low[1] + (j + 1) * s, low[2] + (k + 1) * s}};
        sum += c.solid->clip(c.frame, intersection(cell, c.domain, dimension(c.frame)));
      }
    }
  }
  return sum;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("solids: measure and centroid of the primitives are exact in all frames") {
    for (const Case& c : exact_cases()) {
      CAPTURE(c.name);
      const CellPart part = c.solid->part(c.frame, c.domain);
      CHECK(std::abs(part.measure / c.measure - 1) < 1e-13);
      for (std::size_t a = 0; a < 3; ++a) {
        CHECK(std::abs(part.centroid[a] - c.centroid[a]) < 1e-13 * 25.4e-3);
      }
    }
  }

  TEST_CASE("solids: clips of any lattice add up to the solid") {
    for (const Case& c : exact_cases()) {
      for (const double offset : {0.0, 0.5, 0.137}) {
        CAPTURE(c.name);
        CAPTURE(offset);
        const CellPart sum = sum_of_clips(c, 0.81e-3, offset);
        CHECK(std::abs(sum.measure / c.measure - 1) < 1e-12);
        for (std::size_t a = 0; a < 3; ++a) {
          CHECK(std::abs(sum.centroid[a] - c.centroid[a]) < 1e-12 * 25.4e-3);
        }
      }
    }
  }

  TEST_CASE("solids: plane moments of a disc's part, against the whole and against quadrature") {
    const PlaneMoments whole = disc_moments(2, {-9, 9, -9, 9});
    CHECK(std::abs(whole.area / (4 * pi) - 1) < 1e-15);
    CHECK(std::abs(whole.xx / (4 * pi) - 1) < 1e-15);
    CHECK(std::abs(whole.xy) < 1e-15);
    // A sliver a millionth of the disc: height R - cos = known to leading orders, area 2/3 chord
    // height.
    const double e = 1e-6;
    const PlaneMoments cap = disc_moments(1, {1 - e, 2, -2, 2});
    const double leading = 4.0 / 3 * std::sqrt(2.0) * std::pow(e, 1.5) * (1 - 3 * e / 20);
    CHECK(std::abs(cap.area / leading - 1) < 1e-9);  // 1 - e itself is rounded to 1e-10 of e
    // Random rectangles: split in two, the parts add up; and 4e6 midpoints agree to theirs.
    std::mt19937 random(5);
    std::uniform_real_distribution<double> u(-1.3, 1.3);
    for (int n = 0; n < 2000; ++n) {
      Rectangle b{u(random), u(random), u(random), u(random)};
      if (b.x_min > b.x_max) std::swap(b.x_min, b.x_max);
      if (b.y_min > b.y_max) std::swap(b.y_min, b.y_max);
      const double x = b.x_min + 0.3 * (b.x_max - b.x_min);
      const double y = b.y_min + 0.8 * (b.y_max - b.y_min);
      PlaneMoments sum = disc_moments(1, {b.x_min, x, b.y_min, y});
      sum += disc_moments(1, {x, b.x_max, b.y_min, y});
      sum += disc_moments(1, {b.x_min, x, y, b.y_max});
      sum += disc_moments(1, {x, b.x_max, y, b.y_max});
      const PlaneMoments one = disc_moments(1, b);
      CHECK(std::abs(one.area - sum.area) < 2e-15);
      CHECK(std::abs(one.x - sum.x) < 2e-15);
      CHECK(std::abs(one.y - sum.y) < 2e-15);
      CHECK(std::abs(one.xx - sum.xx) < 2e-15);
      CHECK(std::abs(one.xy - sum.xy) < 2e-15);
    }
    const Rectangle b{-0.2, 0.9, 0.1, 0.95};
    PlaneMoments points;
    const int m = 2000;
    for (int i = 0; i < m; ++i) {
      for (int j = 0; j < m; ++j) {
        const double x = b.x_min + (i + 0.5) / m * 1.1, y = b.y_min + (j + 0.5) / m * 0.85;
        if (x * x + y * y > 1) continue;
        const double da = 1.1 * 0.85 / m / m;
        points += {da, da * x, da * y, da * x * x, da * x * y};
      }
    }
    const PlaneMoments exact = disc_moments(1, b);
    CHECK(std::abs(points.area - exact.area) < 2e-5);
    CHECK(std::abs(points.x - exact.x) < 2e-5);
    CHECK(std::abs(points.y - exact.y) < 2e-5);
    CHECK(std::abs(points.xx - exact.xx) < 2e-5);
    CHECK(std::abs(points.xy - exact.xy) < 2e-5);
  }

  TEST_CASE("solids: a ball's part of any box equals the sum over its pieces") {
    const SphereSolid ball(1, {0.1, -0.2, 0.05});
    std::mt19937 random(7);
    std::uniform_real_distribution<double> u(-1.2, 1.2);
    for (int n = 0; n < 200; ++n) {
      Box b{{u(random), u(random), u(random)}, {u(random), u(random), u(random)}};
      for (std::size_t a = 0; a < 3; ++a) {
        if (b.min[a] > b.max[a]) std::swap(b.min[a], b.max[a]);
      }
      CellPart sum;
      for (int c = 0; c < 8; ++c) {
        Box piece = b;
        for (std::size_t a = 0; a < 3; ++a) {
          ((c >> a) & 1 ? piece.min[a] : piece.max[a]) = 0.37 * b.min[a] + 0.63 * b.max[a];
        }
        sum += ball.clip(Frame::cartesian_3d, piece);
      }
      const CellPart one = ball.clip(Frame::cartesian_3d, b);
      CHECK(std::abs(one.measure - sum.measure) < 1e-13);
      for (std::size_t a = 0; a < 3; ++a) {
        CHECK(std::abs(one.measure * one.centroid[a] - sum.measure * sum.centroid[a]) < 1e-13);
      }
    }
  }

  TEST_CASE("solids: classification never contradicts membership") {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> u(-1, 1);
    for (const Case& c : exact_cases()) {
      CAPTURE(c.name);
      const int dimensions = dimension(c.frame);
      const Box e = c.solid->extent(c.frame);
      for (int n = 0; n < 500; ++n) {
        Box cell{};
        std::array<double, 3> x{};
        for (std::size_t a = 0; a < static_cast<std::size_t>(dimensions); ++a) {
          const double size = e.max[a] - e.min[a];
          cell.min[a] = 0.5 * (e.min[a] + e.max[a]) + 0.7 * size * u(random);
          cell.max[a] = cell.min[a] + 0.1 * size;
          x[a] = cell.min[a] + 0.05 * size * (1 + u(random));
        }
        cell = in_frame(c.frame, cell);
        if (is_empty(cell, dimensions)) continue;
        x[0] = std::max(x[0], cell.min[0]);
        const Place place = c.solid->classify(c.frame, cell);
        const bool in = c.solid->contains(c.frame, x);
        if (place == Place::inside) CHECK(in);
        if (place == Place::outside) CHECK_FALSE(in);
      }
    }
  }

  TEST_CASE("solids: contents by lines are right at any resolution") {
    const Ellipsoid body;
    for (const Frame frame : {Frame::plane_strain, Frame::cartesian_3d}) {
      const double exact = frame == Frame::plane_strain ? 2 * pi : 4 * pi;
      const double allowed = frame == Frame::plane_strain ? 1e-7 : 1e-4;
      for (const int n : {1, 2, 3, 7, 16}) {
        CellPart sum;
        const int layers = frame == Frame::cartesian_3d ? n : 1;
        const Box e = body.extent(frame);
        for (int i = 0; i < n; ++i) {
          for (int j = 0; j < n; ++j) {
            for (int k = 0; k < layers; ++k) {
              Box cell;
              const std::array<int, 3> at{i, j, k};
              for (std::size_t a = 0; a < 3; ++a) {
                const double d = (e.max[a] - e.min[a]) / n;
                cell.min[a] = e.min[a] + d * at[a];
                cell.max[a] = e.min[a] + d * (at[a] + 1);
              }
              sum += body.clip(frame, cell);
            }
          }
        }
        CAPTURE(n);
        CHECK(std::abs(sum.measure / exact - 1) < allowed);
      }
    }
    const CellPart part = body.part(Frame::cartesian_3d, {{0, 0, -9}, {9, 9, 9}});
    CHECK(std::abs(part.measure / pi - 1) < 1e-4);
    CHECK(std::abs(part.centroid[0] - 0.75) < 1e-4);
    CHECK(std::abs(part.centroid[2] - 1) < 1e-4);
  }

  TEST_CASE("solids: what has no meaning is refused with a reason") {
    CHECK_THROWS_AS(BoxSolid(Box{{0, 0, 0}, {1, 0, 1}}), std::invalid_argument);
    CHECK_THROWS_AS(SphereSolid(-1, {0, 0, 0}), std::invalid_argument);
    CHECK_THROWS_AS(SphereSolid(std::nan(""), {0, 0, 0}), std::invalid_argument);
    CHECK_THROWS_AS(CylinderSolid(1, 0, {0, 0, 0}), std::invalid_argument);
    CHECK_THROWS_AS(CylinderSolid(1, 1, {0, 0, 0}, 3), std::invalid_argument);
    const Frame axi = Frame::axisymmetric;
    CHECK_THROWS_AS(BoxSolid::centred({0, 0, 0}, {1, 1, 1}).require(axi), std::invalid_argument);
    CHECK_THROWS_AS(SphereSolid(1, {0.1, 0, 0}).require(axi), std::invalid_argument);
    CHECK_THROWS_AS(CylinderSolid(1, 1, {0, 0, 0}, 0).require(axi), std::invalid_argument);
    CHECK_THROWS_AS(CylinderSolid(1, 1, {0, 1, 0}).require(axi), std::invalid_argument);
    CHECK_NOTHROW(CylinderSolid::centred(1, 1, {0, 0, 5}).require(axi));
  }
}
