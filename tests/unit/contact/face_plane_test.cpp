// SPDX-License-Identifier: GPL-3.0-or-later
// The plane of a face from fillings: those of exact half spaces, of a corner and of a thin body.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "krater/contact/face_plane.hpp"

namespace {

using namespace krater;

/// Integral of the quadratic B-spline up to t.
double spline_below(double t) {
  if (t <= -1.5) return 0;
  if (t >= 1.5) return 1;
  if (t < -0.5) return std::pow(t + 1.5, 3) / 6;
  if (t > 0.5) return 1 - std::pow(1.5 - t, 3) / 6;
  return 0.5 + 0.75 * t - t * t * t / 3;
}

/// Filling of a node whose distance to the face of a half space with normal n is `inside` cells.
double half_space(const std::array<double, 3>& n, double inside, int dimension) {
  constexpr int kParts = 90;
  const double step = 3.0 / kParts;
  double sum = 0;
  for (int i = 0; i < kParts; ++i)
    for (int j = 0; j < (dimension == 3 ? kParts : 1); ++j) {
      const double u = -1.5 + (i + 0.5) * step, v = dimension == 3 ? -1.5 + (j + 0.5) * step : 0;
      const double weight =
          (spline_below(u + 0.5 * step) - spline_below(u - 0.5 * step)) *
          (dimension == 3 ? spline_below(v + 0.5 * step) - spline_below(v - 0.5 * step) : 1);
      const double across = n[0] * u + (dimension == 3 ? n[1] * v : 0);
      const double last = dimension == 3 ? n[2] : n[1];
      sum += weight * spline_below((inside - across) / last);
    }
  return sum;
}

constexpr int kEdge = 5;
using Fillings = std::vector<double>;

/// Nodes at -2 to 2 along every axis; `filling` of a place in cells.
template <class Filling>
Fillings nodes(int dimension, const Filling& filling) {
  Fillings out;
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j)
      for (int k = -2; k <= (dimension == 3 ? 2 : -2); ++k)
        out.push_back(filling(std::array<double, 3>{double(i), double(j), double(k)}));
  return out;
}

FillingWindow middle_of(const Fillings& phi, int dimension) {
  if (dimension == 3) return {phi.data() + 62, {kEdge * kEdge, kEdge, 1}, 3};
  return {phi.data() + 12, {kEdge, 1, 0}, 2};
}

double angle_between(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  double square = 0;
  for (std::size_t k = 0; k < 3; ++k) square += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(square);
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("probit inverts the normal distribution") {
    for (const double z : {-3.0, -1.5, -1.4, -0.3, 0.0, 1e-6, 0.7, 1.43, 2.6})
      CHECK(probit(0.5 * std::erfc(-z / std::numbers::sqrt2)) ==
            doctest::Approx(z).epsilon(1e-6).scale(0.1));
  }

  TEST_CASE("an oblique face is found where central differences err by 0.026") {
    for (const double degree : {3.0, 11.0, 20.0, 33.0, 41.0})
      for (const double reach : {-0.45, -0.2, 0.0, 0.31}) {
        CAPTURE(degree);
        CAPTURE(reach);
        const double angle = degree * std::numbers::pi / 180;
        const std::array<double, 3> n{std::sin(angle), std::cos(angle), 0};
        const Fillings phi = nodes(2, [&](const std::array<double, 3>& x) {
          return half_space(n, reach - n[0] * x[0] - n[1] * x[1], 2);
        });
        std::array<double, 3> guess = filling_gradient(middle_of(phi, 2));
        const double length = std::hypot(guess[0], guess[1]);
        for (double& g : guess) g /= -length;
        if (degree == 20.0) CHECK(angle_between(guess, n) > 0.02);
        for (const int radius : {1, 2}) {
          const FacePlane face = fit_face(middle_of(phi, 2), guess, radius, shape_spread(false));
          CHECK(angle_between(face.normal, n) < 1e-3);
          // lumps of half a cell would lie 4 % nearer
          CHECK(face.reach == doctest::Approx(reach).epsilon(0.05).scale(0.05));
          CHECK(face.trust > 0.95);
        }
      }
  }

  TEST_CASE("in 3D") {
    const std::array<double, 3> n{0.28, 0.19, std::sqrt(1 - 0.28 * 0.28 - 0.19 * 0.19)};
    for (const double reach : {-0.4, 0.1}) {
      const Fillings phi = nodes(3, [&](const std::array<double, 3>& x) {
        return half_space(n, reach - n[0] * x[0] - n[1] * x[1] - n[2] * x[2], 3);
      });
      const FacePlane face = fit_face(middle_of(phi, 3), n, 1, shape_spread(false));
      CHECK(angle_between(face.normal, n) < 1e-3);
      CHECK(face.trust > 0.95);
    }
  }

  TEST_CASE("corners and thin bodies are not trusted") {
    const auto product = [](double width, double height) {  // a block's corner, or a strip's end
      return [=](const std::array<double, 3>& x) {
        return (spline_below(0.2 - x[0]) - spline_below(0.2 - x[0] - width)) *
               (spline_below(0.1 - x[1]) - spline_below(0.1 - x[1] - height));
      };
    };
    const double r = std::numbers::sqrt2 / 2;
    const Fillings corner = nodes(2, product(9, 9)), strip = nodes(2, product(1.2, 9));
    for (const int radius : {1, 2})
      CHECK(fit_face(middle_of(corner, 2), {r, r, 0}, radius, shape_spread(false)).trust < 0.2);
    CHECK(fit_face(middle_of(strip, 2), {1, 0, 0}, 2, shape_spread(false)).trust < 0.2);
    const Fillings none(25, 0.0), full(25, 1.0);
    CHECK(fit_face(middle_of(none, 2), {1, 0, 0}, 2, shape_spread(false)).trust == 0);
    CHECK(fit_face(middle_of(full, 2), {1, 0, 0}, 2, shape_spread(false)).trust == 0);
  }

  TEST_CASE("linear functions spread less") {
    CHECK(shape_spread(true).deviation ==
          doctest::Approx(std::sqrt(1.0 / 6 - 1.0 / 48)).epsilon(1e-12));
    CHECK(shape_spread(false).deviation ==
          doctest::Approx(std::sqrt(1.0 / 4 - 1.0 / 48)).epsilon(1e-12));
  }
}
