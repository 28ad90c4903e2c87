// SPDX-License-Identifier: GPL-3.0-or-later
// Gases, detonation products and Tillotson at single points: exact Riemann states, the
// Chapman-Jouguet state of TNT, branches and their borders, Algorithm 1 on isentropes.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "krater/materials/eos/jwl.hpp"
#include "krater/materials/eos/mie_gruneisen_polynomial.hpp"
#include "krater/materials/eos/mie_gruneisen_shock.hpp"
#include "krater/materials/eos/stiffened_gas.hpp"
#include "krater/materials/eos/tillotson.hpp"
#include "krater/materials/stages/eos_stage.hpp"

namespace {

using namespace krater;

IdealGas ideal(double gamma, double rho0, double p0) {
  const double values[] = {gamma, p0};
  return make_law<IdealGas>(values, {rho0, 0.0, 294.0});
}
StiffenedGas stiffened(double gamma, double p_inf, double rho0, double p0) {
  const double values[] = {gamma, p_inf, p0};
  return make_law<StiffenedGas>(values, {rho0, 0.0, 294.0});
}
/// TNT of Lee, Hornig, Kury 1968 (Dobratz 1981): D = 6930 m/s, p_CJ = 21.0 GPa.
Jwl tnt() {
  const double values[] = {371.2e9, 3.231e9, 4.15, 0.95, 0.30, 7.0e9};
  return make_law<Jwl>(values, {1630.0, 0.0, 294.0});
}
/// Iron: Tillotson 1962 as tabulated in planetary codes.
Tillotson iron() {
  const double values[] = {0.5, 1.5, 128e9, 105e9, 9.5e6, 2.4e6, 8.67e6, 5.0, 5.0};
  return make_law<Tillotson>(values, {7860.0, 0.0, 294.0});
}

template <class Law>
double pressure(const Law& law, double rho, double e) {
  return pressure_at(law, rho, 1.0 / rho, e);
}

/// A state on the shock or isentrope from the start of `law` to pressure p.
struct Wave {
  double rho, velocity;  ///< |u - u_0|
};

template <class Law>
Wave shock_to(const Law& law, double p) {
  const double p0 = pressure_at_start(law), e0 = energy_at_start(law), v0 = 1.0 / law.rho0;
  double low = law.rho0, high = 50.0 * law.rho0;
  for (int i = 0; i < 200; ++i) {
    const double rho = 0.5 * (low + high);
    const double e = e0 + 0.5 * (p + p0) * (v0 - 1.0 / rho);
    (pressure(law, rho, e) < p ? low : high) = rho;
  }
  return {low, std::sqrt((p - p0) * (v0 - 1.0 / low))};
}

/// Along the isentrope by Algorithm 1 in small steps of log rho, down to p.
template <class Law>
Wave rarefy_to(const Law& law, double p_end) {
  double rho = law.rho0, p = pressure_at_start(law), e = energy_at_start(law), u = 0.0;
  double factor = 1.0 - 1e-5;
  const auto sound = [&] { return std::sqrt(law.bulk_modulus(rho, 1.0 / rho, p, e) / rho); };
  while (factor < 1.0 - 1e-13) {
    const double next = rho * factor, v = 1.0 / next;
    const auto step = advance_energy(law, next, v, p, e, v - 1.0 / rho, 0.0);
    if (step.pressure < p_end) {
      factor = 0.5 * (1.0 + factor);
      continue;
    }
    const double c0 = sound();
    const double log_step = -std::log(factor);
    rho = next, p = step.pressure, e = step.energy;
    u += 0.5 * (c0 + sound()) * log_step;
  }
  return {rho, u};
}

struct Riemann {
  double p, u, rho_left, rho_right;
};
/// Both at rest, the left one at the higher pressure: rarefaction to the left, shock to the right.
template <class Left, class Right>
Riemann solve(const Left& left, const Right& right) {
  double low = pressure_at_start(right), high = pressure_at_start(left);
  for (int i = 0; i < 26; ++i) {
    const double p = 0.5 * (low + high);
    (shock_to(right, p).velocity < rarefy_to(left, p).velocity ? low : high) = p;
  }
  const Wave fan = rarefy_to(left, low), shock = shock_to(right, low);
  return {low, fan.velocity, fan.rho, shock.rho};
}

/// e on the isentrope from the start to density ratio x: Runge-Kutta in v.
template <class Law>
double isentrope(const Law& law, double x) {
  constexpr int fine = 20000;
  const double v0 = 1.0 / law.rho0, dv = (v0 / x - v0) / fine;
  double e = energy_at_start(law);
  for (int i = 0; i < fine; ++i) {
    const double v = v0 + i * dv;
    const auto slope = [&](double at, double energy) { return -pressure(law, 1.0 / at, energy); };
    const double k1 = slope(v, e), k2 = slope(v + 0.5 * dv, e + 0.5 * dv * k1);
    const double k3 = slope(v + 0.5 * dv, e + 0.5 * dv * k2), k4 = slope(v + dv, e + dv * k3);
    e += dv * (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0;
  }
  return e;
}

/// Error of Algorithm 1 in so many steps to x, over the change of energy.
template <class Law>
double march_error(const Law& law, double x, int steps, double exact) {
  const double v0 = 1.0 / law.rho0, dv = (v0 / x - v0) / steps;
  double p = pressure_at_start(law), e = energy_at_start(law);
  for (int i = 0; i < steps; ++i) {
    const double v = v0 + (i + 1) * dv;
    const auto step = advance_energy(law, 1.0 / v, v, p, e, dv, 0.0);
    CHECK(step.denominator > 0.5);
    CHECK(step.pressure == doctest::Approx(pressure(law, 1.0 / v, step.energy)).epsilon(1e-10));
    p = step.pressure, e = step.energy;
  }
  return (e - exact) / (exact - energy_at_start(law));
}

template <class Law>
void check_second_order(const Law& law, double x) {
  CAPTURE(std::string{Law::name});
  CAPTURE(x);
  const double exact = isentrope(law, x);
  const double coarse = march_error(law, x, 40, exact), fine = march_error(law, x, 80, exact);
  CHECK(std::fabs(coarse) < 1e-2);
  CHECK(coarse / fine > 3.7);
  CHECK(coarse / fine < 4.3);
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("ideal gas: the states of Sod's tube, theory D4") {
    const Riemann sod = solve(ideal(1.4, 1.0, 1.0), ideal(1.4, 0.125, 0.1));
    CHECK(sod.p == doctest::Approx(0.303130).epsilon(2e-6));
    CHECK(sod.u == doctest::Approx(0.927453).epsilon(2e-6));
    CHECK(sod.rho_left == doctest::Approx(0.426319).epsilon(2e-6));
    CHECK(sod.rho_right == doctest::Approx(0.265574).epsilon(2e-6));
  }

  TEST_CASE("stiffened gas: water against a light gas, symmetric impacts, theory D4") {
    const Riemann water = solve(stiffened(4.4, 6e8, 1000.0, 1e9), stiffened(1.4, 0.0, 50.0, 1e5));
    CHECK(water.p == doctest::Approx(1.41905e7).epsilon(1e-5));
    CHECK(water.u == doctest::Approx(482.610).epsilon(1e-5));
    CHECK(water.rho_left == doctest::Approx(804.445).epsilon(1e-5));
    CHECK(water.rho_right == doctest::Approx(288.168).epsilon(1e-5));
    const struct {
      StiffenedGas law;  // from 1e5 Pa: the digits of theory D4 tell it from zero
      double closing, p, rho;
    } impacts[] = {{stiffened(3.8, 20.805e9, 2785.0, 1e5), 100.0, 0.75043e9, 2811.08},
                   {stiffened(3.8, 20.805e9, 2785.0, 1e5), 1000.0, 8.30175e9, 3039.96},
                   {stiffened(4.0, 34.656e9, 8930.0, 1e5), 100.0, 1.78744e9, 9042.95},
                   {stiffened(4.0, 34.656e9, 8930.0, 1e5), 1000.0, 20.6028e9, 10015.25}};
    for (const auto& impact : impacts) {
      // Us^2 - (gamma + 1)/2 u Us - c0^2 = 0, p = p0 + rho0 Us u: exact for this gas.
      const double u = 0.5 * impact.closing, half = 0.25 * (impact.law.gamma + 1.0) * u;
      const double Us = half + std::sqrt(half * half + impact.law.c0 * impact.law.c0);
      const double p = 1e5 + impact.law.rho0 * Us * u;
      const Wave shock = shock_to(impact.law, p);
      CHECK(shock.velocity == doctest::Approx(u).epsilon(1e-9));
      CHECK(shock.rho == doctest::Approx(impact.law.rho0 * Us / (Us - u)).epsilon(1e-11));
      CHECK(p == doctest::Approx(impact.p).epsilon(1e-5));  // as printed
      CHECK(shock.rho == doctest::Approx(impact.rho).epsilon(2e-6));
    }
  }

  TEST_CASE("gases start at their pressure, with its energy and sound speed") {
    const StiffenedGas law = stiffened(4.4, 6e8, 1000.0, 1e9);
    CHECK(pressure_at_start(law) == doctest::Approx(1e9).epsilon(1e-14));
    CHECK(law.initial_energy == doctest::Approx((1e9 + 4.4 * 6e8) / (3.4 * 1000.0)));
    CHECK(law.c0 == doctest::Approx(std::sqrt(4.4 * 1.6e9 / 1000.0)));
    CHECK(ideal(1.4, 1.0, 0.0).problem() != nullptr);
    CHECK(ideal(1.0, 1.0, 1.0).problem() != nullptr);
    CHECK(stiffened(4.4, 6e8, 1000.0, 0.0).problem() == nullptr);
  }

  TEST_CASE("JWL: the Chapman-Jouguet state of TNT follows from its constants") {
    // On the Hugoniot of the unburnt state (p = 0, e = E0/rho0 released) the detonation is where
    // the Rayleigh line is steepest-tangent: D is a minimum.
    const Jwl law = tnt();
    const double v0 = 1.0 / law.rho0, e0 = law.initial_energy;
    double best = 1e300, best_p = 0.0;
    for (double x = 1.05; x < 1.8; x += 1e-5) {
      const double v = v0 / x, rho = law.rho0 * x;
      // p = F + omega rho e, e = e0 + p (v0 - v)/2.
      const auto s = law.split(rho, v);
      const double p = (s.cold + s.thermal * e0) / (1.0 - 0.5 * s.thermal * (v0 - v));
      const double D = v0 * std::sqrt(p / (v0 - v));
      if (D < best) best = D, best_p = p;
    }
    CHECK(best == doctest::Approx(6930.0).epsilon(2e-3));
    CHECK(best_p == doctest::Approx(21.0e9).epsilon(5e-3));
  }

  TEST_CASE("Tillotson: published branches, continuous across their borders") {
    const Tillotson law = iron();
    const auto condensed = [&](double x, double e) {
      const double mu = x - 1.0, E = 7860.0 * x * e;
      return 0.5 * E + 1.5 * E / (e / (9.5e6 * x * x) + 1.0) +
             cohesion(x).share * (128e9 * mu + 105e9 * mu * mu);
    };
    const auto expanded = [&](double x, double e) {
      const double E = 7860.0 * x * e, z = 1.0 / x - 1.0;
      return 0.5 * E +
             (1.5 * E / (e / (9.5e6 * x * x) + 1.0) + 128e9 * (x - 1.0) * std::exp(-5.0 * z)) *
                 std::exp(-5.0 * z * z);
    };
    for (const double x : {1.0, 1.3, 2.0})
      for (const double e : {0.0, 1e6, 2e7})
        CHECK(pressure(law, 7860.0 * x, e) == doctest::Approx(condensed(x, e)).epsilon(1e-13));
    for (const double x : {0.05, 0.5, 0.98}) {
      CHECK(pressure(law, 7860.0 * x, 2e6) == doctest::Approx(condensed(x, 2e6)).epsilon(1e-12));
      CHECK(pressure(law, 7860.0 * x, 2e7) == doctest::Approx(expanded(x, 2e7)).epsilon(1e-12));
      const double half = 0.5 * (2.4e6 + 8.67e6);
      CHECK(pressure(law, 7860.0 * x, half) ==
            doctest::Approx(0.5 * (condensed(x, half) + expanded(x, half))).epsilon(1e-12));
      for (const double border : {2.4e6, 8.67e6})
        CHECK(pressure(law, 7860.0 * x, border * (1.0 - 1e-12)) ==
              doctest::Approx(pressure(law, 7860.0 * x, border * (1.0 + 1e-12))).epsilon(1e-9));
    }
    // Thin vapour is an ideal gas of gamma = 1 + a; below e = 0 there is no pole.
    CHECK(pressure(law, 1.0, 5e7) == doctest::Approx(0.5 * 5e7).epsilon(1e-12));
    CHECK(pressure(law, 7860.0 * 0.9, -1e5) ==
          doctest::Approx(condensed(0.9, -1e5)).epsilon(1e-12));
    CHECK(pressure(law, 7860.0 * 0.6, -3.5e6) <  // E0 x^2 = 3.42e6
          pressure(law, 7860.0 * 0.6, -1e6));
    CHECK(std::isfinite(pressure(law, 7860.0 * 0.6, -3.42e6)));
    CHECK(pressure(law, 7860.0 * 0.1, -9.5e4) == 0.0);
    CHECK(law.c0 == doctest::Approx(std::sqrt(128e9 / 7860.0)));
  }

  TEST_CASE("Algorithm 1: second order along isentropes of every new law") {
    check_second_order(ideal(1.4, 1.2, 1e5), 3.0);
    check_second_order(ideal(1.4, 1.2, 1e5), 0.4);
    check_second_order(stiffened(4.4, 6e8, 1000.0, 1e9), 0.8);
    check_second_order(stiffened(3.8, 20.805e9, 2785.0, 1e5), 1.3);
    check_second_order(tnt(), 1.4);
    check_second_order(tnt(), 0.3);
    check_second_order(iron(), 1.5);
    check_second_order(iron(), 0.95);
  }

  TEST_CASE("Tillotson: a thin gas pushes, about a rho e, also between E_iv and E_cv") {
    const double values[] = {0.5, 1.63, 75e9, 65e9, 5e6, 3e6, 15e6, 5.0, 5.0};
    const auto law = make_law<Tillotson>(values, {2700.0, 0.0, 294.0});
    for (double x = 1e-6; x <= 1.001e-2; x *= 10) {
      for (const double e : {3.1e6, 5e6, 11.3e6, 14.9e6, 15.1e6, 30e6}) {
        const double gas = 0.5 * 2700.0 * x * e;
        CHECK(pressure(law, 2700.0 * x, e) >= 0.0);
        CHECK(pressure(law, 2700.0 * x, e) <= 2.0 * gas);
        CHECK(law.tangent(2700.0 * x, 1.0 / (2700.0 * x), e).thermal <= 2.0 * 0.5 * 2700.0 * x);
      }
    }
    // Where the solid has parted no state pulls, whatever its energy.
    for (const double x : {1e-4, 0.1, 0.3, 0.5})
      for (const double e : {-1e6, -1.0, 0.0, 1e5, 2.9e6})
        CHECK(pressure(law, 2700.0 * x, e) >= 0.0);
  }

  TEST_CASE("eos: finite at any density and energy, and c^2 after its floor") {
    const auto check = [](const auto& law, bool gas = true) {
      for (const double x : {1e-9, 1e-4, 0.1, 0.5, 0.6, 0.8, 1.0, 1.3, 3.0, 10.0, 100.0}) {
        for (const double e : {-1e7, -1e3, 0.0, 1e5, 1e7, 1e9}) {
          const double rho = x * law.rho0, v = 1.0 / rho, p = pressure(law, rho, e);
          CHECK(std::isfinite(p));
          CHECK(std::isfinite(law.bulk_modulus(rho, v, p, e)));
        }
      }
      if (!gas) return;  // hot and thin: sound without the floor
      const double rho = 1e-3 * law.rho0, p = pressure(law, rho, 1e8);
      CHECK(law.bulk_modulus(rho, 1.0 / rho, p, 1e8) > 0.0);
    };
    const double shock[] = {3940.0, 1.489, 2.02}, polynomial[] = {76e9, 128e9, 125e9, 2.0};
    check(make_law<MieGruneisenShock>(shock, {8930.0, 0.0, 294.0}), false);  // solids for ever
    check(make_law<MieGruneisenPolynomial>(polynomial, {2700.0, 0.0, 294.0}), false);
    check(iron());
    check(tnt());
    check(ideal(1.4, 1.2, 1e5));
    check(stiffened(4.4, 6e8, 1000.0, 1e9), false);  // a liquid for ever
  }

  TEST_CASE("Tillotson: Newton on e converges for any step, also across the borders") {
    const Tillotson law = iron();
    for (const double x : {0.1, 0.5, 0.9, 0.999, 1.0, 1.2, 2.0}) {
      for (const double e : {-1e5, 0.0, 1e6, 2.39e6, 2.41e6, 5e6, 8.66e6, 8.68e6, 1e8}) {
        for (const double change : {-0.2, -1e-3, 1e-3, 0.2}) {
          const double rho = 7860.0 * x, v = 1.0 / rho;
          const double p = pressure(law, rho, e);
          const double v1 = v * (1.0 + change), rho1 = 1.0 / v1;
          const auto step = advance_energy(law, rho1, v1, p, e, v1 - v, 10.0);
          CHECK(step.denominator > 0.0);
          CHECK(std::fabs(step.pressure - pressure(law, rho1, step.energy)) <
                1e-9 * (128e9 * 1e-3 + std::fabs(step.pressure)));
          CHECK(step.energy ==
                doctest::Approx(e + 10.0 - 0.5 * (p + step.pressure) * (v1 - v)).epsilon(1e-9));
        }
      }
    }
  }
}
