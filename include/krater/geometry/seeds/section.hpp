// SPDX-License-Identifier: GPL-3.0-or-later
// Exact moments of plane regions: int (1, x, y, x^2, x y) dA over a rectangle, and over disc n
// rectangle.
//
// The disc's part is cut into strips between the abscissae where its outline meets the rectangle's
// sides. A strip is a trapezoid below its chords plus circular segments. With t = tan(theta / 4),
// t0 at the chord's end, a segment is, from chord to arc, 2 R (t0^2 - t^2) / ((1 + t^2)(1 + t0^2))
// high at w = 2 R t / (1 + t^2): rational, positive, free of cancellation, so that 16-point
// Gauss-Legendre quadrature (arcs of at most a quarter turn, poles at t = +-i) gives all moments to
// round-off, even of a sliver far smaller than the disc.
#pragma once

#include <array>

namespace krater {

struct PlaneMoments {
  double area = 0;  ///< int dA
  double x = 0;     ///< int x dA
  double y = 0;     ///< int y dA
  double xx = 0;    ///< int x^2 dA
  double xy = 0;    ///< int x y dA

  PlaneMoments& operator+=(const PlaneMoments& other);
};

struct Rectangle {
  double x_min, x_max, y_min, y_max;
};

/// The same region, its coordinates counted from an origin that lies at (-dx, -dy).
PlaneMoments shifted(const PlaneMoments& moments, double dx, double dy);

/// Moments of a rectangle; zero where it is empty.
PlaneMoments rectangle_moments(const Rectangle& rectangle);

/// Moments of the part of `rectangle` in the disc about the origin; zero where they do not meet.
PlaneMoments disc_moments(double radius, const Rectangle& rectangle);

/// Nodes and weights of Gauss-Legendre quadrature with 16 points on [-1, 1]: the positive half.
struct HalfGauss16 {
  static constexpr std::array<double, 8> node{
      0.0950125098376374402, 0.2816035507792589132, 0.4580167776572273863, 0.6178762444026437484,
      0.7554044083550030339, 0.8656312023878317439, 0.9445750230732325761, 0.9894009349916499326};
  static constexpr std::array<double, 8> weight{
      0.1894506104550684963, 0.1826034150449235889, 0.1691565193950025382, 0.1495959888165767321,
      0.1246289712555338720, 0.0951585116824927848, 0.0622535239386478929, 0.0271524594117540949};
};

}  // namespace krater
