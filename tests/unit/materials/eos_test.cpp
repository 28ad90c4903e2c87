// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "hugoniot_rows.hpp"
#include "krater/materials/eos/mie_gruneisen_polynomial.hpp"
#include "krater/materials/eos/mie_gruneisen_shock.hpp"
#include "krater/materials/stages/eos_stage.hpp"

namespace {

using namespace krater;

MieGruneisenShock shock(double rho0, double c0, double S1, double gamma0) {
  const double values[] = {c0, S1, gamma0};
  return make_law<MieGruneisenShock>(values, {rho0, 0.0, 294.0});
}

template <class Law>
double pressure(const Law& law, double rho, double e) {
  const auto split = law.split(rho, 1.0 / rho);
  return split.cold + split.thermal * e;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("Mie-Grueneisen shock: the Hugoniot comes back, hugoniot.csv") {
    for (const test::HugoniotRow& row : test::kHugoniot) {
      CAPTURE(std::string{row.material});
      CAPTURE(row.up);
      const auto law = shock(row.rho0, row.c0, row.S1, row.gamma0);
      const double Us = row.c0 + row.S1 * row.up;
      const double P = row.rho0 * Us * row.up;
      CHECK(P == doctest::Approx(row.pressure).epsilon(1e-5));
      CHECK(Us / (Us - row.up) == doctest::Approx(row.compression).epsilon(1e-6));
      // Solve p(rho, P (v0 - v)/2) = P for rho by bisection: it must be rho0 Us/(Us - up).
      double low = row.rho0, high = 2.2 * row.rho0;
      for (int i = 0; i < 100; ++i) {
        const double rho = 0.5 * (low + high);
        const double e = 0.5 * P * (1.0 / row.rho0 - 1.0 / rho);
        (pressure(law, rho, e) < P ? low : high) = rho;
      }
      CHECK(low == doctest::Approx(row.rho0 * Us / (Us - row.up)).epsilon(1e-9));
      // And the printed row itself.
      const double rho = row.rho0 * row.compression;
      const double e = 0.5 * row.pressure * (1.0 / row.rho0 - 1.0 / rho);
      CHECK(e == doctest::Approx(0.5 * row.up * row.up).epsilon(3e-5));
      const double exact = row.rho0 * Us / (Us - row.up);
      CHECK(pressure(law, exact, 0.5 * row.up * row.up) == doctest::Approx(P).epsilon(1e-6));
    }
  }

  TEST_CASE("Mie-Grueneisen polynomial: on p_H where e = p_H (v0 - v)/2, materials of theory D1") {
    // Steel and aluminium of CCF's Table 1; pressures of symmetric impact at 1 km/s.
    const double steel[] = {163.9e9, 294.4e9, 500e9, 1.16};
    const double al[] = {76.74e9, 128.3e9, 125.1e9, 2.0};
    const struct {
      MieGruneisenPolynomial law;
      double P;
    } cases[] = {{make_law<MieGruneisenPolynomial>(steel, {7823.0, 0.0, 294.0}), 20.774e9},
                 {make_law<MieGruneisenPolynomial>(al, {2768.0, 0.0, 294.0}), 8.227e9}};
    for (const auto& c : cases) {
      double low = 1.0, high = 2.0;  // P = p_H and up^2 = P (v0 - v)
      for (int i = 0; i < 100; ++i) {
        const double x = 0.5 * (low + high), mu = x - 1.0;
        const double p_h = mu * (c.law.a0 + mu * (c.law.b0 + mu * c.law.cubic));
        const double e = 0.5 * p_h * (1.0 - 1.0 / x) / c.law.rho0;
        CHECK(pressure(c.law, x * c.law.rho0, e) == doctest::Approx(p_h).epsilon(1e-10));
        (2.0 * e < 500.0 * 500.0 ? low : high) = x;
      }
      const double mu = low - 1.0;
      CHECK(mu * (c.law.a0 + mu * (c.law.b0 + mu * c.law.cubic)) ==
            doctest::Approx(c.P).epsilon(1e-3));
    }
  }

  TEST_CASE(
      "Mie-Grueneisen shock: continuous with its slope at the pole's continuation, and counted") {
    const auto law = shock(8930.0, 3940.0, 1.489, 2.02);
    const double rho_c = law.rho0 / (1.0 - law.eta_c);
    const double h = 1e-6;
    const double below = pressure(law, rho_c * (1.0 - h), 0.0);
    const double at = pressure(law, rho_c, 0.0);
    const double above = pressure(law, rho_c * (1.0 + h), 0.0);
    CHECK((above - at) / (at - below) == doctest::Approx(1.0).epsilon(1e-4));
    CHECK_FALSE(law.beyond_pole(rho_c * (1.0 - h)));
    CHECK(law.beyond_pole(rho_c * (1.0 + h)));
    // Past the pole itself (eta = 1/S1) the pressure still rises.
    const double rho_pole = law.rho0 / (1.0 - 1.0 / law.S1);
    CHECK(pressure(law, 1.01 * rho_pole, 1e6) > pressure(law, rho_pole, 1e6));
    CHECK(std::isfinite(pressure(law, 50.0 * law.rho0, 1e6)));
    // A flat Hugoniot has no pole.
    CHECK_FALSE(shock(8930.0, 3940.0, 0.0, 2.0).beyond_pole(1e7));
  }

  TEST_CASE("Algorithm 1: second order along an isentrope, closed energy cycle") {
    // de = -p dv from rho0 to 1.3 rho0; the reference is a fourth-order integration with tiny
    // steps.
    const auto law = shock(8930.0, 3940.0, 1.489, 2.02);
    const double v0 = 1.0 / law.rho0, v1 = v0 / 1.3;
    double e = 0.0;
    constexpr int fine = 20000;
    const double dv = (v1 - v0) / fine;
    for (int i = 0; i < fine; ++i) {
      const double v = v0 + i * dv;
      const auto slope = [&](double at, double energy) { return -pressure(law, 1.0 / at, energy); };
      const double k1 = slope(v, e), k2 = slope(v + 0.5 * dv, e + 0.5 * dv * k1);
      const double k3 = slope(v + 0.5 * dv, e + 0.5 * dv * k2), k4 = slope(v + dv, e + dv * k3);
      e += dv * (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0;
    }
    const auto march = [&](int steps, bool back) {
      double p = 0.0, energy = 0.0;
      for (int leg = 0; leg < (back ? 2 : 1); ++leg) {
        const double from = leg == 0 ? v0 : v1, to = leg == 0 ? v1 : v0;
        for (int i = 0; i < steps; ++i) {
          const double step = (to - from) / steps;
          const double v = i + 1 == steps ? to : from + (i + 1) * step;
          const auto split = law.split(1.0 / v, v);
          const auto closed = close_energy(split, p, energy, step, 0.0);
          p = closed.pressure;
          energy = closed.energy;
          CHECK(closed.pressure == doctest::Approx(pressure(law, 1.0 / v, energy)).epsilon(1e-12));
        }
      }
      return energy;
    };
    const double coarse = std::fabs(march(20, false) - e), finer = std::fabs(march(40, false) - e);
    CHECK(coarse < 2e-3 * e);
    CHECK(coarse / finer > 3.7);
    CHECK(coarse / finer < 4.3);
    // Trapezoid there and back over the same volumes: the energy returns to round-off.
    CHECK(std::fabs(march(20, true)) < 1e-11 * e);
  }

  TEST_CASE("alpha of Algorithm 1: the pressures of start and end do their shares of the work") {
    const auto law = shock(8930.0, 3940.0, 1.489, 2.02);
    const double v0 = 1.0 / law.rho0, v1 = 0.9 * v0, p = 3e9, e = 1e4, dv = v1 - v0;
    const auto split = law.split(1.0 / v1, v1);
    for (const double alpha : {0.0, 0.5, 1.0}) {
      const auto step = close_energy(split, p, e, VolumeChange<double>{dv, alpha}, 50.0);
      const double work = -(alpha * p + (1.0 - alpha) * step.pressure) * dv;
      CHECK(step.energy == doctest::Approx(e + 50.0 + work).epsilon(1e-13));
      // Of the energy that it takes for the end's; explicit where alpha is 1.
      CHECK(step.pressure == doctest::Approx(pressure(law, 1.0 / v1, step.energy)).epsilon(1e-12));
    }
    const auto half = close_energy(split, p, e, dv, 50.0);
    CHECK(half.pressure == close_energy(split, p, e, VolumeChange<double>{dv, 0.5}, 50.0).pressure);
  }
}
