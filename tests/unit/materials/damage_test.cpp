// SPDX-License-Identifier: GPL-3.0-or-later
// Damage laws against theory D10 and their equations, and the return with damage inside (theory
// 4).
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "krater/materials/damage/johnson_cook.hpp"
#include "krater/materials/damage/lemaitre.hpp"
#include "krater/materials/damage/strain_criteria.hpp"
#include "krater/materials/returns/rate_return.hpp"
#include "krater/materials/strength/johnson_cook.hpp"
#include "krater/materials/strength/von_mises.hpp"

namespace {

using namespace krater;

const MaterialConstants kSteel{7850.0, 200e9 / 2.6, 294.0};

template <class Law>
Law make(std::initializer_list<double> values) {
  return make_law<Law>(values.begin(), kSteel);
}

/// Weldox 460 E as in the CCF paper.
JohnsonCookDamage weldox(double gamma_D, double phi_c, double normalise) {
  return make<JohnsonCookDamage>(
      {0.0705, 1.732, -0.54, -0.0123, 0.0, 1.0, 294.0, 0.0, 1e-3, gamma_D, phi_c, normalise});
}

DamageDriver<double> state(double chi, double q = 300e6) {
  const double E = 200e9, nu = 0.3;
  return {.s = {2.0 / 3.0 * q, -q / 3.0, -q / 3.0, 0.0, 0.0, 0.0},
          .q = q,
          .pressure = -chi * q,
          .triaxiality = chi,
          .K = E / (3.0 * (1.0 - 2.0 * nu)),
          .G = E / (2.0 * (1.0 + nu)),
          .rate = 1.0,
          .temperature = 294.0};
}

double log_uniform(std::mt19937& random, double low, double high) {
  return std::exp(std::uniform_real_distribution<double>{std::log(low), std::log(high)}(random));
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("Lemaitre: uniaxial strain with constant yield stress, theory D10") {
    // Undamaged ratio p/Y: chi = K eps/Y; plastic strain 2/3 (eps - Y/2G); s = 1.
    const LemaitreEnergy law = make<LemaitreEnergy>({2e6, 1.0, 0.0, 0.999, -1.0 / 3.0});
    const auto damage = [&](double end) {
      const double Y = 300e6, eps0 = Y / (2.0 * kSteel.shear_modulus);
      const int n = 2000;  // midpoint rule
      double phi = 0.0;
      for (int i = 0; i < n; ++i) {
        const double eps = eps0 + (end - eps0) * (i + 0.5) / n;
        const auto x = state(state(0.0).K * eps / Y);
        phi = damage_after(law.growth(x), phi, 1.0, 2.0 / 3.0 * (end - eps0) / n);
      }
      return phi;
    };
    CHECK(std::fabs(damage(0.01) - 0.009714) < 6e-7);
    CHECK(std::fabs(damage(0.02) - 0.075179) < 6e-7);
  }

  TEST_CASE("Lemaitre: uniaxial stress, exponent, cut-off and threshold form") {
    const LemaitreEnergy law = make<LemaitreEnergy>({2e6, 1.0, 0.1, 0.5, -1.0 / 3.0});
    // R_v(1/3) = 1: phi' = Y^2/(2 E S).
    CHECK(law.growth(state(1.0 / 3.0)).k == doctest::Approx(9e16 / (2 * 200e9 * 2e6)));
    CHECK(law.growth(state(1.0 / 3.0)).eps_D == 0.1);
    CHECK(law.growth(state(-1.0 / 3.0)).k == 0.0);
    CHECK(law.growth(state(-0.33)).k > 0.0);
    const LemaitreEnergy square = make<LemaitreEnergy>({2e6, 2.0, 0.1, 0.5, -1.0 / 3.0});
    CHECK(square.growth(state(1.0)).k ==
          doctest::Approx(std::pow(law.growth(state(1.0)).k, 2.0)).epsilon(1e-12));
    const LemaitreThreshold other = make<LemaitreThreshold>({0.5, 0.1, 1.5, 0.4, -1.0 / 3.0});
    CHECK(other.growth(state(1.0 / 3.0)).k == doctest::Approx(0.4 / 0.4));
    CHECK(other.growth(state(1.0 / 3.0)).eps_D == doctest::Approx(0.1));
    const double R = triaxiality_function(state(2.0));
    CHECK(R == doctest::Approx(2.0 / 3.0 * 1.3 + 3.0 * 0.4 * 4.0));
    CHECK(other.growth(state(2.0)).k == doctest::Approx(std::pow(R, 1.5)));
    CHECK(other.growth(state(2.0)).eps_D == doctest::Approx(0.1 / std::pow(R, 1.5)));
    CHECK(other.growth(state(-0.5)).k == 0.0);
  }

  TEST_CASE("Johnson-Cook damage: Weldox 1.5172, 1.8025, .8410 (theory D10), growth, clamps") {
    const JohnsonCookDamage law = weldox(0.0, 0.9, 0.0);
    const auto eps_F = [&](double chi) { return law.fracture_strain(state(chi)); };
    CHECK(std::fabs(eps_F(1.0 / 3.0) - 1.5172) < 6e-5);
    CHECK(std::fabs(eps_F(0.0) - 1.8025) < 6e-5);
    CHECK(std::fabs(eps_F(1.5) - 0.8410) < 6e-5);
    CHECK(eps_F(7.0) == eps_F(1.5));
    CHECK(eps_F(-9.0) == eps_F(-5.0));
    auto fast = state(0.0);
    fast.rate = 1e4;
    CHECK(law.fracture_strain(fast) ==
          doctest::Approx(1.8025 * (1.0 - 0.0123 * std::log(1e4))).epsilon(1e-12));
    fast.rate = 1e-4;
    CHECK(law.fracture_strain(fast) == eps_F(0.0));
    const auto hot =
        make<JohnsonCookUncoupled>({0.0705, 1.732, -0.54, 0.0, 2.0, 1.0, 294.0, 1294.0, 1e-3, 0.0});
    auto warm = state(0.0);
    warm.temperature = 544.0;
    CHECK(hot.fracture_strain(warm) == doctest::Approx(1.8025 * 1.5).epsilon(1e-12));
    const auto negative =
        make<JohnsonCookUncoupled>({-1.0, 0.1, -0.54, 0.0, 0.0, 1.0, 294.0, 0.0, 2e-3, 0.0});
    CHECK(negative.fracture_strain(state(0.0)) == 2e-3);
    // As printed phi = (eps - eps_D)/(eps_F - eps_D): phi_c at eps_D + phi_c (eps_F - eps_D).
    const auto printed = weldox(0.2, 0.3, 0.0).growth(state(0.0)),
               critical = weldox(0.2, 0.3, 1.0).growth(state(0.0));
    CHECK(printed.eps_D == doctest::Approx(0.2 * 1.8025));
    CHECK(printed.k * 0.8 * 1.8025 == doctest::Approx(1.0));
    CHECK(critical.k * 0.8 * 1.8025 == doctest::Approx(0.3));
    CHECK(weldox(0.2, 0.9995, 0.0).problem() != nullptr);
    CHECK(weldox(1.0, 0.9, 0.0).problem() != nullptr);
  }

  TEST_CASE("damage after a strain: threshold crossed inside a step, cap at phi_c") {
    const Growth<double> growth{2.0, 0.1, 0.5};
    CHECK(damage_after(growth, 0.0, 0.09, 0.05) == 0.0);
    CHECK(damage_after(growth, 0.0, 0.13, 0.05) == doctest::Approx(0.06));
    CHECK(damage_after(growth, 0.2, 0.3, 0.05) == doctest::Approx(0.3));
    CHECK(damage_after(growth, 0.2, 0.9, 0.5) == 0.5);
    CHECK(damage_after(growth, 0.2, 0.3, 0.0) == 0.2);
    CHECK(std::isnan(damage_after(growth, std::nan(""), 0.3, 0.0)));
  }

  TEST_CASE("Cockcroft-Latham: largest principal stress") {
    std::mt19937 random{4};
    std::normal_distribution<double> normal;
    for (int i = 0; i < 2000; ++i) {
      const Sym3<double> s =
          1e8 * dev(Sym3<double>{normal(random), normal(random), normal(random), normal(random),
                                 normal(random), normal(random)});
      const double t = largest_principal(s);
      // Root of the characteristic polynomial, and no larger one: its slope is positive.
      const double J2 = 0.5 * contract(s, s);
      REQUIRE(std::fabs(t * t * t - J2 * t - det(s)) < 1e-12 * std::pow(J2, 1.5));
      REQUIRE(3.0 * t * t - J2 > -1e-6 * J2);
      REQUIRE(t >= 0.0);
    }
    CHECK(largest_principal(Sym3<double>{-2.0, 1.0, 1.0, 0.0, 0.0, 0.0}) ==
          doctest::Approx(1.0).epsilon(1e-7));
    CHECK(largest_principal(zero_sym3<double>()) == 0.0);
    const CockcroftLatham law = make<CockcroftLatham>({500e6});
    CHECK(law.growth(state(1.0 / 3.0)).k == doctest::Approx(300e6 / 500e6));
    CHECK(law.growth(state(-2.0)).k == 0.0);
    CHECK(make<MaximumPlasticStrain>({0.25}).growth(state(0.0)).k == doctest::Approx(4.0));
  }

  TEST_CASE("return with damage: residual below 1e-10 of yield over 1e5 random states") {
    std::mt19937 random{13};
    std::uniform_real_distribution<double> unit;
    const double values[] = {90e6, 292e6, 0.31, 0.025, 1.0, 1.09, 294.0, 1356.0}, G = 46e9;
    const JohnsonCook law = make_law<JohnsonCook>(values, {8960.0, G, 294.0});
    int snapped = 0, capped = 0;
    for (int i = 0; i < 100000; ++i) {
      const double dt = log_uniform(random, 1e-12, 1e-5);
      const double eps = unit(random) < 0.3 ? 0.0 : log_uniform(random, 1e-9, 10.0);
      const double T = unit(random) < 0.2 ? 1356.0 - log_uniform(random, 1e-9, 1.0)
                                          : 200.0 + 1200.0 * unit(random);
      const double phi_c = unit(random) < 0.5 ? 0.999 : 0.05 + 0.9 * unit(random);
      const double phi = unit(random) < 0.3 ? 0.0 : phi_c * (1.0 - log_uniform(random, 1e-12, 1.0));
      const Growth<double> growth{log_uniform(random, 1e-3, 1e4),
                                  unit(random) < 0.5 ? 0.0 : eps * 2.0 * unit(random), phi_c};
      const auto curve = law.at(T);
      const double still = curve.hardening(eps).stress;
      const double q = unit(random) < 0.5 ? still + 3.0 * G * log_uniform(random, 1e-12, 1.0)
                                          : still * (0.5 + log_uniform(random, 1e-6, 1e3));
      const double rate = unit(random) < 0.1 ? 0.0 : log_uniform(random, 1e-6, 1e9);
      const auto [step, snap] = rate_return(curve, q, eps, G, phi, growth, rate * dt, dt);
      REQUIRE_FALSE(step.unconverged);
      REQUIRE(step.yielding == (q > still));
      if (!step.yielding) continue;
      REQUIRE(step.d >= 0.0);
      const double sigma = flow_at(curve, eps + step.d, step.d / dt).stress;
      const double after = damage_after(growth, phi, eps + step.d, step.d);
      const double ratio = (1.0 - after) / (1.0 - phi);
      REQUIRE(std::fabs(q - 3.0 * G * step.d - ratio * sigma) <= 1e-10 * ratio * sigma + 2e-15 * q);
      REQUIRE(after <= phi_c);
      capped += after == phi_c ? 1 : 0;
      snapped += snap ? 1 : 0;
      if (snap) continue;
      // The smallest root: nothing below it has a residual of the other sign.
      for (const double part : {0.01, 0.3, 0.7, 0.99}) {
        const double x = part * step.d;
        if (x <= 0.0) continue;
        const double r = (1.0 - damage_after(growth, phi, eps + x, x)) / (1.0 - phi);
        REQUIRE(q - 3.0 * G * x - r * flow_at(curve, eps + x, x / dt).stress >= -1e-10 * q);
      }
    }
    CHECK(snapped > 100);
    CHECK(capped > 1000);
    MESSAGE("snapped ", snapped, ", reached phi_c ", capped);
  }

  TEST_CASE("return with damage: the stress rate of (32) and (43) as dt -> 0, at first order") {
    // Radial loading: dq/d strain = (1 - phi) 3G H/(3G + H), H = h - k sigma_Y/(1 - phi).
    const double values[] = {90e6, 292e6, 0.31, 0.0, 1.0, 1.09, 294.0, 1356.0}, G = 46e9;
    const JohnsonCook law = make_law<JohnsonCook>(values, {8960.0, G, 294.0});
    const auto curve = law.at(294.0);
    const double eps = 0.2, phi = 0.3;
    const Growth<double> growth{1.4, 0.1, 0.9};
    const auto flow = flow_at(curve, eps, 0.5);
    const double H = flow.d_eps - growth.k * flow.stress / (1.0 - phi);
    const double expected = (1.0 - phi) * 3.0 * G * H / (3.0 * G + H);
    double last = 0.0;
    for (const double strain : {1e-3, 5e-4, 2.5e-4}) {
      const double q = flow.stress + 3.0 * G * strain;
      const auto result = rate_return(curve, q, eps, G, phi, growth, strain, 1.0);
      const double after = damage_after(growth, phi, eps + result.step.d, result.step.d);
      const double slope =
          ((1.0 - after) * result.step.stress - (1.0 - phi) * flow.stress) / strain;
      const double error = std::fabs(slope - expected);
      CHECK(error < 0.02 * std::fabs(expected));
      if (last > 0.0) CHECK(last / error == doctest::Approx(2.0).epsilon(0.05));
      last = error;
    }
    // The effective coupling leaves k out of H.
    CHECK(expected < 0.0);
  }

  TEST_CASE("return with damage: viscous rate (43): dq with the rate term, first order") {
    const double values[] = {90e6, 292e6, 0.31, 0.025, 1.0, 1.09, 294.0, 1356.0}, G = 46e9;
    const JohnsonCook law = make_law<JohnsonCook>(values, {8960.0, G, 294.0});
    const auto curve = law.at(294.0);
    // Steady rate: start from the state where the increment per time is the strain rate's root.
    const Growth<double> growth{1.4, 0.1, 0.9};
    const double rate = 1e4, end = 0.01;
    double q_end[3];
    for (int level = 0; level < 3; ++level) {
      const int n = 200 << level;
      const double dE = end / n, dt = dE / rate;
      double eps = 0.2, phi = 0.3, q = flow_at(curve, eps, rate).stress;  // effective
      for (int i = 0; i < n; ++i) {
        const auto r = rate_return(curve, q + 3.0 * G * dE, eps, G, phi, growth, dE, dt);
        phi = damage_after(growth, phi, eps + r.step.d, r.step.d);
        eps += r.step.d;
        q = r.step.stress;
      }
      q_end[level] = (1.0 - phi) * q;
    }
    const double order = std::log2(std::fabs(q_end[0] - q_end[1]) / std::fabs(q_end[1] - q_end[2]));
    CHECK(order == doctest::Approx(1.0).epsilon(0.1));
  }

  TEST_CASE("return with damage: snap-back is seen, NaN is no convergence") {
    const double values[] = {460e6, 0.0}, G = 75e9;
    const auto curve = make_law<VonMises>(values, {7850.0, G, 294.0}).at(0.0);
    const double k = 1.0 / 1.5172;  // Weldox: k Y > 3G (1 - phi) above phi = 1 - .00135
    const auto at = [&](double phi, double slope) {
      return rate_return(curve, 470e6, 0.5, G, phi, Growth<double>{slope, 0.0, 0.999}, 1e-5, 1e-8);
    };
    CHECK_FALSE(at(0.9, k).snapped);
    CHECK(at(0.9, 100.0 * k).snapped);
    CHECK_FALSE(at(0.0, 100.0 * k).snapped);
    CHECK(rate_return(curve, std::nan(""), 0.5, G, 0.1, Growth<double>{k, 0.0, 0.9}, 1e-5, 1e-8)
              .step.unconverged);
    CHECK(rate_return(curve, 5e8, 0.5, G, std::nan(""), Growth<double>{k, 0.0, 0.9}, 1e-5, 1e-8)
              .step.unconverged);
  }
}
