// SPDX-License-Identifier: GPL-3.0-or-later
// The generalized vortex (Kamojjala, Brannon, Sadeghirad, Guilkey 2015; theory D6): the ring
// .75 < R < 1.25 of a neo-Hookean plane is twisted to and fro,
//   x = Q(a) X, a = g(t) h(R), g = A sin(pi t), h = 1 - 32 (R - 1)^2 + 256 (R - 1)^4,
// J = 1, shear R g h' up to 6 A. In the axes turned with the point
//   b_r = -R (g' h)^2 + (mu/rho) R (g h')^2,  b_t = R g'' h - (mu/rho)(3 g h' + R g h'').
// h and h' vanish at both edges, so a disc that is at rest outside the ring is a solution as well:
// there is no free surface in the way.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <sstream>
#include <vector>

#include "verification/run_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

constexpr double pi = std::numbers::pi;
constexpr double kModulus = 1000, kPoisson = 0.3, kDensity = 1000;
constexpr double kOverDensity = kModulus / (2 * (1 + kPoisson)) / kDensity;  ///< mu/rho

double profile(double R) {
  const double s = (R - 1) * (R - 1);
  return std::abs(R - 1) < 0.25 ? 1 - 32 * s + 256 * s * s : 0;
}
double turn(double R, double t, double A) { return A * std::sin(pi * t) * profile(R); }

std::string disc(double h, double A) {
  std::ostringstream yaml, inside, f, f1, f2, g, a, br, bt;
  for (std::ostringstream* s : {&yaml, &f, &f1, &f2, &g, &a, &br, &bt, &inside}) s->precision(17);
  const std::string R = "sqrt(X^2+Z^2)", s = "(" + R + "-1)";
  inside << "abs(" << s << ")<0.25";
  f << "(1-32*" << s << "^2+256*" << s << "^4)";
  f1 << "(64*" << s << "*(16*" << s << "^2-1))";
  f2 << "(64*(48*" << s << "^2-1))";
  g << "(" << A << "*sin(pi*t))";
  a << "(" << g.str() << "*" << f.str() << ")";
  br << "(-" << R << "*(" << A << "*pi*cos(pi*t)*" << f.str() << ")^2+" << kOverDensity << "*" << R
     << "*(" << g.str() << "*" << f1.str() << ")^2)";
  bt << "(-" << R << "*pi^2*" << a.str() << "-" << kOverDensity << "*" << g.str() << "*(3*"
     << f1.str() << "+" << R << "*" << f2.str() << "))";
  const std::string cosine = "(X*cos(" + a.str() + ")-Z*sin(" + a.str() + "))/" + R,
                    sine = "(X*sin(" + a.str() + ")+Z*cos(" + a.str() + "))/" + R;
  yaml << "frame: plane_strain\n"
       << "grid:\n  cell: " << h << "\n  box: {min: [-1.5, -1.5], max: [1.5, 1.5]}\n"
       << "time: {end: 1, cfl: 0.4}\n"
       << "materials:\n  rubber: {density: " << kDensity << ", youngs_modulus: " << kModulus
       << ", poisson_ratio: " << kPoisson << ", strength: neo_hookean}\n"
       << "bodies:\n  disc:\n    material: rubber\n"
       << "    shape: {cylinder: {radius: 1.4, height: 1, axis: y, base: [0, -0.5, 0]}}\n"
       << "    velocity: [\"" << inside.str() << " ? -" << A << "*pi*Z*" << f.str() << " : 0\", \""
       << inside.str() << " ? " << A << "*pi*X*" << f.str() << " : 0\"]\n"
       << "body_force: [\"" << inside.str() << " ? " << br.str() << "*" << cosine << "-" << bt.str()
       << "*" << sine << " : 0\", \"" << inside.str() << " ? " << br.str() << "*" << sine << "+"
       << bt.str() << "*" << cosine << " : 0\"]\n";
  return yaml.str();
}

/// Root of the mean square of the displacement's error over the points that began in the ring [m].
double error_now(const Run& run, double A) {
  const auto X = column(run, field::ReferencePosition::info, 0),
             Z = column(run, field::ReferencePosition::info, 1),
             x = column(run, field::Position::info, 0), z = column(run, field::Position::info, 1);
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < X.size(); ++i) {
    const double R = std::hypot(X[i], Z[i]);
    if (std::abs(R - 1) >= 0.25) continue;
    const double a = turn(R, run.sim->time(), A), c = std::cos(a), s = std::sin(a);
    sum += std::pow(x[i] - (X[i] * c - Z[i] * s), 2) + std::pow(z[i] - (X[i] * s + Z[i] * c), 2);
    count += 1;
  }
  return std::sqrt(sum / count);
}

/// Errors at the time of greatest twist, t = 1/2, and at t = 1, when all points are back.
std::array<double, 2> errors(double h, double A, const Overrides& method) {
  Run run = start_text(disc(h, A), method);
  run_to(run, 0.5);
  const double half = error_now(run, A);
  run_to(run, 1);
  return {half, error_now(run, A)};
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("generalized vortex: the body force balances the momentum of the given motion") {
    // Second differences of the motion, stress sigma = mu (F F^T - 1), P = sigma F^-T, J = 1.
    const double A = 1;
    const Run run = start_text(disc(0.125, A));
    using Vector = std::array<double, 2>;
    using Matrix = std::array<std::array<double, 2>, 2>;
    const auto place = [&](double X, double Z, double t) {
      const double a = turn(std::hypot(X, Z), t, A);
      return Vector{X * std::cos(a) - Z * std::sin(a), X * std::sin(a) + Z * std::cos(a)};
    };
    const double e = 1e-4;
    const auto stress = [&](double X, double Z, double t) {
      const Vector dx = place(X + e, Z, t), dX = place(X - e, Z, t), dz = place(X, Z + e, t),
                   dZ = place(X, Z - e, t);
      Matrix F;
      for (std::size_t i = 0; i < 2; ++i)
        F[i] = {(dx[i] - dX[i]) / (2 * e), (dz[i] - dZ[i]) / (2 * e)};
      const double J = F[0][0] * F[1][1] - F[0][1] * F[1][0];
      // P/rho = (mu/rho)(F - F^-T)
      return Matrix{
          {{kOverDensity * (F[0][0] - F[1][1] / J), kOverDensity * (F[0][1] + F[1][0] / J)},
           {kOverDensity * (F[1][0] + F[0][1] / J), kOverDensity * (F[1][1] - F[0][0] / J)}}};
    };
    for (const Vector& X : {Vector{0.9, 0.1}, Vector{-0.3, 1.05}, Vector{0.6, -0.6}})
      for (const double t : {0.1, 0.5, 0.8}) {
        const Matrix px = stress(X[0] + e, X[1], t), pX = stress(X[0] - e, X[1], t),
                     pz = stress(X[0], X[1] + e, t), pZ = stress(X[0], X[1] - e, t);
        const Vector now = place(X[0], X[1], t), later = place(X[0], X[1], t + e),
                     before = place(X[0], X[1], t - e);
        const Triple b = (*run.scene->body_force)({now[0], now[1], 0}, {X[0], X[1], 0}, t);
        for (std::size_t i = 0; i < 2; ++i) {
          const double a = (later[i] - 2 * now[i] + before[i]) / (e * e);
          const double divergence = (px[i][0] - pX[i][0] + pz[i][1] - pZ[i][1]) / (2 * e);
          CHECK(a - b[i] == doctest::Approx(divergence).epsilon(1e-4).scale(1));
        }
      }
    for (const Vector& X : {Vector{0.5, 0.1}, Vector{1.3, 0}}) {
      const Triple b = (*run.scene->body_force)({X[0], X[1], 0}, {X[0], X[1], 0}, 0.3);
      CHECK(b[0] == 0);
      CHECK(b[1] == 0);
    }
  }

  TEST_CASE("generalized vortex: the displacement converges with 4 points per direction") {
    // Shear 2, stretches up to 2.4: with 2 points per direction neighbours are then more than a
    // cell apart.
    const double A = 1.0 / 3;
    std::vector<double> h, half, end;
    for (const int n : {8, 12, 16}) {
      h.push_back(1.0 / n);
      const auto [at_half, at_end] = errors(h.back(), A, {"method.points_per_direction=4"});
      half.push_back(at_half), end.push_back(at_end);
      MESSAGE("h 1/", n, ": error ", at_half, " m at t = 1/2, ", at_end, " m at t = 1");
      if (h.size() == 1) continue;
      CHECK(half.back() < half[half.size() - 2]);
      CHECK(end.back() < end[end.size() - 2]);
    }
    MESSAGE("orders ", observed_order(h, half), ", ", observed_order(h, end));
    // The ring is 4 to 8 cells wide: not yet the second order of finer grids (validation/).
    CHECK(observed_order(h, half) > 0.9);
    CHECK(observed_order(h, end) > 1.5);
    // Known limit of the current configuration: the default lattice does not converge here.
    const auto [sparse_half, sparse_end] = errors(1.0 / 16, A, {});
    MESSAGE("2 points per direction, h 1/16: ", sparse_half, ", ", sparse_end);
    CHECK(sparse_end > 4 * end.back());
  }

  TEST_CASE(
      "generalized vortex: second order on the initial configuration, with the default lattice") {
    // Theorem 1: no crossed cells and no gaps, so 2 points per direction do, at three times the
    // twist.
    const double A = 1;
    std::vector<double> h, half, end;
    for (const int n : {8, 16, 32}) {
      h.push_back(1.0 / n);
      const auto [at_half, at_end] = errors(h.back(), A, {"method.reference=initial"});
      half.push_back(at_half), end.push_back(at_end);
      MESSAGE("h 1/", n, ": error ", at_half, " m at t = 1/2, ", at_end, " m at t = 1");
    }
    MESSAGE("orders ", observed_order(h, half), ", ", observed_order(h, end));
    // At t = 1/2 of the two finer grids: 1.18 from 1/8 to 1/16, 2.13 from there to 1/32. Over all
    // three it was 1.8 while the filter damped the whole residual: that made the coarsest grid's
    // error .0745 instead of .0617 m. Unfiltered motion has today's errors, then and now, to 0.2 %.
    CHECK(observed_order({h[1], h[2]}, {half[1], half[2]}) > 1.8);
    CHECK(observed_order(h, end) > 1.8);
  }
}
