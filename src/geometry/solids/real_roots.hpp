// SPDX-License-Identifier: GPL-3.0-or-later
// Real roots in [-1, 1] of a polynomial of degree 4 or less: between neighbouring roots of its
// derivative it is monotonic, so a sign change brackets one root, found by Newton's method with
// bisection as safeguard. Double roots (a line that only touches) may go unseen.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace krater {

/// c[0] + c[1] x + ...
using Quartic = std::array<double, 5>;

struct Roots {
  std::array<double, 4> x{};
  std::size_t count = 0;
};

inline double value(const Quartic& c, std::size_t degree, double x) {
  double sum = c[degree];
  for (std::size_t n = degree; n-- > 0;) sum = sum * x + c[n];
  return sum;
}

/// The root between two points of opposite sign.
inline double bracketed_root(const Quartic& c, const Quartic& slope, std::size_t degree, double a,
                             double b) {
  const bool rising = value(c, degree, a) < 0;
  double x = 0.5 * (a + b);
  for (int n = 0; n < 80 && b - a > 1e-16; ++n) {
    const double f = value(c, degree, x);
    ((f < 0) == rising ? a : b) = x;
    const double next = x - f / value(slope, degree - 1, x);
    const bool newton = next > a && next < b;
    if (newton && std::abs(next - x) < 1e-16) return next;
    x = newton ? next : 0.5 * (a + b);
  }
  return x;
}

inline Roots real_roots(const Quartic& c, std::size_t degree) {
  Roots roots;
  if (degree == 0) return roots;
  Quartic slope{};
  for (std::size_t n = 1; n <= degree; ++n) slope[n - 1] = static_cast<double>(n) * c[n];
  const Roots turns = real_roots(slope, degree - 1);
  double a = -1;
  for (std::size_t n = 0; n <= turns.count; ++n) {
    const double b = n < turns.count ? turns.x[n] : 1.0;
    if ((value(c, degree, a) < 0) != (value(c, degree, b) < 0)) {
      roots.x[roots.count++] = bracketed_root(c, slope, degree, a, b);
    }
    a = b;
  }
  return roots;
}

}  // namespace krater
