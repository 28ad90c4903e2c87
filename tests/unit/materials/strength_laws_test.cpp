// SPDX-License-Identifier: GPL-3.0-or-later
// Flow stresses at single points, against the printed equations with constants of the sources, and
// the scalar solve of the radial return for each of them.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "krater/materials/returns/radial_return.hpp"
#include "krater/materials/strength/johnson_cook.hpp"
#include "krater/materials/strength/steinberg_guinan.hpp"
#include "krater/materials/strength/voce.hpp"
#include "krater/materials/strength/zerilli_armstrong.hpp"

namespace {

using namespace krater;

constexpr double G = 47.7e9;
const MaterialConstants kCopper{8930.0, G, 294.0};

// Copper and Armco iron of Zerilli and Armstrong 1987 (from memory of their Table I).
ZerilliArmstrongFcc za_copper() {
  const double values[] = {65e6, 890e6, 0.0028, 0.000115, 1e-4};
  return make_law<ZerilliArmstrongFcc>(values, kCopper);
}
ZerilliArmstrongBcc za_iron() {
  const double values[] = {0.0, 1033e6, 0.00698, 0.000415, 266e6, 0.289, 1e-4};
  return make_law<ZerilliArmstrongBcc>(values, kCopper);
}
template <class Law>
Law voce() {
  const double values[] = {90e6, 120e6, 15.0, 150e6, 1.5, 0.012, 5e-4, 1.09, 294.0, 1356.0};
  return make_law<Law>(values, kCopper);
}
/// OFHC copper, half hard: Steinberg 1996 as in Uintah's MaterialData.
SteinbergGuinan sg_copper() {
  const double values[] = {0.12e9,  0.64e9, 36.0,   0.45, 0.0, 2.83e-11,
                           3.77e-4, 1.0,    1790.0, 1.5,  2.02};
  return make_law<SteinbergGuinan>(values, kCopper);
}

double log_uniform(std::mt19937& random, double low, double high) {
  return std::exp(std::uniform_real_distribution<double>{std::log(low), std::log(high)}(random));
}

/// The residual of the scalar equation over random states, below 1e-10 of yield.
void check_residuals(const auto& law, unsigned seed) {
  std::mt19937 random{seed};
  std::uniform_real_distribution<double> unit;
  for (int i = 0; i < 100000; ++i) {
    const double dt = log_uniform(random, 1e-12, 1e-5);
    const double eps = unit(random) < 0.3 ? 0.0 : log_uniform(random, 1e-9, 10.0);
    const StartState<double> start{100.0 + 2000.0 * unit(random), -5e9 + 2e11 * unit(random),
                                   0.9 + unit(random)};
    const auto curve = curve_at(law, start);
    const double shear = shear_at(law, start, G);
    const double still = curve.hardening(eps).stress;
    const double q = unit(random) < 0.5 ? still + 3.0 * shear * log_uniform(random, 1e-12, 1.0)
                                        : still * (0.5 + log_uniform(random, 1e-6, 1e3));
    const double rate = unit(random) < 0.1 ? 0.0 : log_uniform(random, 1e-6, 1e9);
    const auto step = radial_return(curve, q, eps, shear, rate * dt, dt);
    REQUIRE_FALSE(step.unconverged);
    REQUIRE(step.yielding == (q > still));
    if (!step.yielding) continue;
    REQUIRE(step.d >= 0.0);
    const double sigma = flow_at(curve, eps + step.d, step.d / dt).stress;
    const double allowed = 1e-10 * sigma + 2e-15 * q;
    REQUIRE(std::fabs(q - 3.0 * shear * step.d - sigma) <= allowed);
    REQUIRE(std::fabs(step.stress - sigma) <= allowed);
  }
}

/// The bound that spares the evaluation of a law: below it, nearly to the melting point, and a NaN
/// gets through.
template <class Law>
void check_bound(const Law& law, double T_ref, double T_melt, unsigned seed) {
  std::mt19937 random{seed};
  std::uniform_real_distribution<double> unit;
  for (int i = 0; i < 100000; ++i) {
    const double eps = unit(random) < 0.2 ? 0.0 : log_uniform(random, 1e-12, 10.0);
    const double part = log_uniform(random, 1e-14, 1.0);
    const StartState<double> start{unit(random) < 0.5 ? T_ref + part * (T_melt - T_ref)
                                                      : T_melt - part * (T_melt - T_ref)};
    const double still = law.at(start.temperature).hardening(eps).stress;
    REQUIRE(law.least_yield(eps, start.temperature) <= still);
    const double q = still * (0.2 + 1.2 * unit(random)), dt = 1e-8;
    const auto a = plastic_step(law, start, q, eps, G, 1e-4, dt);
    const auto b = radial_return(law.at(start.temperature), q, eps, G, 1e-4, dt);
    REQUIRE(a.d == b.d);
    REQUIRE(a.yielding == b.yielding);
    if (b.yielding) REQUIRE(a.stress == b.stress);
  }
  CHECK(law.least_yield(0.0, T_ref) > 0.6 * law.at(T_ref).hardening(0.0).stress);
  const double nan = std::nan("");
  CHECK(plastic_step(law, StartState<double>{nan}, 1e6, 0.1, G, 1e-4, 1e-8).unconverged);
  CHECK(plastic_step(law, StartState<double>{T_ref}, nan, 0.1, G, 1e-4, 1e-8).unconverged);
  CHECK(plastic_step(law, StartState<double>{T_ref}, 1e6, nan, G, 1e-4, 1e-8).unconverged);
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("least yield: a bound for every exponent, and the same step with it and without") {
    for (const double n : {0.26, 1.0, 1.4})
      for (const double m : {0.7, 1.0, 1.09, 2.0}) {
        const double values[] = {90e6, 292e6, n, 0.025, 1.0, m, 294.0, 1356.0};
        check_bound(make_law<JohnsonCook>(values, kCopper), 294.0, 1356.0, 23);
      }
    check_bound(voce<Voce>(), 294.0, 1356.0, 29);
    check_bound(voce<VoceLog>(), 294.0, 1356.0, 31);
  }

  TEST_CASE("Zerilli-Armstrong: flow stress of copper and iron at a strain, rate and temperature") {
    // 0.3, 1e3 /s, 300 K, worked out apart from the code.
    CHECK(flow_at(za_copper().at(300.0), 0.3, 1e3).stress ==
          doctest::Approx(332.081169465e6).epsilon(1e-11));
    CHECK(flow_at(za_iron().at(300.0), 0.3, 1e3).stress ==
          doctest::Approx(488.569604897e6).epsilon(1e-11));
    for (const double T : {77.0, 300.0, 800.0}) {
      for (const double rate : {1e-3, 1.0, 1e5}) {
        for (const double eps : {1e-4, 0.05, 1.0}) {
          CHECK(flow_at(za_copper().at(T), eps, rate).stress ==
                doctest::Approx(65e6 + 890e6 * std::sqrt(eps) *
                                           std::exp(-0.0028 * T + 0.000115 * T * std::log(rate)))
                    .epsilon(1e-13));
          CHECK(flow_at(za_iron().at(T), eps, rate).stress ==
                doctest::Approx(1033e6 * std::exp(-0.00698 * T + 0.000415 * T * std::log(rate)) +
                                266e6 * std::pow(eps, 0.289))
                    .epsilon(1e-13));
        }
      }
    }
    // Below epsdot0 the static curve; fcc yields at C0 whatever the temperature.
    const auto cold = za_copper().at(300.0);
    CHECK(flow_at(cold, 0.3, 1e-9).stress == cold.hardening(0.3).stress);
    CHECK(za_copper().at(900.0).hardening(0.0).stress == 65e6);
  }

  TEST_CASE("Voce: both rate factors, saturation, softening to nothing at the melting point") {
    for (const double eps : {1e-6, 0.05, 2.0, 50.0}) {
      const double still =
          90e6 + 120e6 * (1.0 - std::exp(-15.0 * eps)) + 150e6 * (1.0 - std::exp(-1.5 * eps));
      for (const double T : {200.0, 294.0, 800.0}) {
        const double soft = 1.0 - std::pow(std::max(0.0, (T - 294.0) / (1356.0 - 294.0)), 1.09);
        for (const double rate : {1e-6, 1.0, 1e5}) {
          CHECK(flow_at(voce<Voce>().at(T), eps, rate).stress ==
                doctest::Approx(still * soft * std::pow(1.0 + rate / 5e-4, 0.012)).epsilon(1e-13));
          CHECK(flow_at(voce<VoceLog>().at(T), eps, rate).stress ==
                doctest::Approx(still * soft * (1.0 + 0.012 * std::log(std::max(1.0, rate / 5e-4))))
                    .epsilon(1e-13));
        }
      }
    }
    CHECK(voce<Voce>().at(294.0).hardening(100.0).stress == doctest::Approx(360e6).epsilon(1e-14));
    CHECK(voce<Voce>().at(294.0).hardening(0.0).stress == 90e6);
    CHECK(flow_at(voce<Voce>().at(1356.0), 0.1, 1e4).stress == 0.0);
  }

  TEST_CASE("Steinberg-Guinan: modulus, yield and melting point of copper at pressure") {
    const SteinbergGuinan law = sg_copper();
    CHECK(law.shear_modulus(300.0, 0.0, 1.0) == doctest::Approx(G).epsilon(1e-15));
    // 50 GPa, rho/rho0 = 1.23, 600 K, eps = 0.1: worked out apart from the code.
    CHECK(law.shear_modulus(600.0, 50e9, 1.23) == doctest::Approx(105.3001834008e9).epsilon(1e-11));
    const auto curve = law.at(600.0, 50e9, 1.23);
    CHECK(flow_at(curve, 0.1, 1e6).stress == doctest::Approx(526.4207733572e6).epsilon(1e-11));
    CHECK(law.melting_temperature(1.23) == doctest::Approx(3388.802179295).epsilon(1e-11));
    // Hardening ends at Y_max: eps_cap = ((640/120)^(1/0.45) - 1)/36.
    CHECK(law.eps_cap == doctest::Approx((std::pow(640.0 / 120.0, 1.0 / 0.45) - 1.0) / 36.0));
    const auto rest = law.at(300.0, 0.0, 1.0);
    CHECK(rest.hardening(0.999 * law.eps_cap).stress < 0.64e9);
    CHECK(rest.hardening(1.001 * law.eps_cap).stress == 0.64e9);
    CHECK(rest.hardening(0.0).stress == 0.12e9);
    // Molten: no strength, a modulus that still divides; pressure freezes it again.
    CHECK(law.at(1790.0, 0.0, 1.0).hardening(0.3).stress == 0.0);
    CHECK(law.at(1789.0, 0.0, 1.0).hardening(0.3).stress > 0.0);
    CHECK(law.at(1790.0, 20e9, 1.1).hardening(0.3).stress > 0.0);
    CHECK(law.shear_modulus(5000.0, 0.0, 1.0) == doctest::Approx(1e-3 * G));
    CHECK(law.at(5000.0, 0.0, 1.0).hardening(0.3).stress == 0.0);
  }

  TEST_CASE("radial return: residual below 1e-10 of yield over 1e5 random states, every law") {
    check_residuals(za_copper(), 1);
    check_residuals(za_iron(), 2);
    check_residuals(voce<Voce>(), 3);
    check_residuals(voce<VoceLog>(), 4);
    check_residuals(sg_copper(), 5);
  }
}
