// SPDX-License-Identifier: GPL-3.0-or-later
// Damage that needs no plastic strain: Tuler and Butcher's integral against its closed forms, alone
// and through the stages of a solid that never yields.
#include "krater/materials/damage/tuler_butcher.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "contract/material_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;
using doctest::Approx;

constexpr double kStress = 50e6, kExponent = 1.5, kTime = 2e-7;

TulerButcher law() {
  const double values[] = {kStress, kExponent, kTime};
  return make_law<TulerButcher>(values, kCopper);
}

/// Uniaxial tension sigma.
DamageDriver<double> pulled(double sigma, double dt) {
  return {.s = {2.0 / 3.0 * sigma, -sigma / 3.0, -sigma / 3.0, 0.0, 0.0, 0.0},
          .q = std::fabs(sigma),
          .pressure = -sigma / 3.0,
          .triaxiality = 1.0 / 3.0,
          .K = 139e9,
          .G = 46e9,
          .rate = 1.0,
          .temperature = 294.0,
          .dt = dt};
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("Tuler-Butcher: a constant stress fails at tau (sigma/sigma_0 - 1)^-a, a ramp later") {
    for (const double sigma : {60e6, 100e6, 175e6}) {
      CAPTURE(sigma);
      const double until = kTime * std::pow(sigma / kStress - 1, -kExponent), dt = until / 500;
      double phi = 0;
      for (int n = 0; n < 500; ++n) {
        CHECK(phi < 1);
        phi = damage_after(law().growth(pulled(sigma, dt)), phi, 0.0, 0.0);
      }
      CHECK(phi == Approx(1).epsilon(1e-12));
    }
    // sigma_0 (1 + t/t_r) by the midpoint rule.
    const double rise = 3e-8;
    const double until =
        std::pow((kExponent + 1) * kTime * std::pow(rise, kExponent), 1 / (kExponent + 1));
    const int steps = 4000;
    double phi = 0;
    for (int n = 0; n < steps; ++n) {
      const double t = (n + 0.5) * until / steps;
      phi += law().growth(pulled(kStress * (1 + t / rise), until / steps)).source;
    }
    CHECK(phi == Approx(1).epsilon(1e-6));
    // Compression, and a tension borne for ever.
    CHECK(law().growth(pulled(-500e6, 1e-8)).source == 0);
    CHECK(law().growth(pulled(0.9999 * kStress, 1e-8)).source == 0);
  }

  TEST_CASE("a source of damage adds to what flow does, and stops at phi_c") {
    const Growth<double> growth{2.0, 0.1, 0.5, 0.03};
    CHECK(damage_after(growth, 0.0, 0.13, 0.05) == Approx(0.09));
    CHECK(damage_after(growth, 0.2, 0.05, 0.01) == Approx(0.23));
    CHECK(damage_after(growth, 0.49, 0.05, 0.01) == 0.5);
    CHECK(damage_by_flow(growth, 0.2, 0.05, 0.01) == 0.2);  // the return does not see it
    CHECK(std::isnan(damage_after(growth, std::nan(""), 0.3, 0.0)));
  }

  TEST_CASE("Tuler-Butcher through the stages: an elastic solid held in tension fails in time") {
    Recipe recipe{.strength = "elastic",
                  .eos = "linear",
                  .viscosity = false,
                  .damage = "tuler_butcher",
                  .parameters = {{"tuler_butcher.stress", kStress},
                                 {"tuler_butcher.exponent", kExponent},
                                 {"tuler_butcher.time", kTime}}};
    Body body{*stage_factory_isa_portable(), recipe, 1, 1};
    const double dt = 1e-9;
    body.local("step_gradient", 0, 0) = 4e-4;
    body.step(dt);
    body.local("step_gradient", 0, 0) = 0;
    const auto sigma = [&] {
      return body.state("deviatoric_stress", 0) - body.state("pressure", 0);
    };
    const double held = sigma(), begun = body.state("damage", 0);
    REQUIRE(held > 1.2 * kStress);
    const double rate = std::pow(held / kStress - 1, kExponent) / kTime;
    const int last = static_cast<int>(std::ceil((1 - begun) / (rate * dt)));
    REQUIRE(last > 20);
    for (int n = 1; n <= last; ++n) {
      CHECK(body.state("failed", 0) == 0);
      CHECK(sigma() == Approx(held).epsilon(1e-12));
      body.step(dt);
      if (n < last) CHECK(body.state("damage", 0) == Approx(begun + n * dt * rate).epsilon(1e-9));
    }
    CHECK(body.state("failed", 0) == 1);
    CHECK(body.state("deviatoric_stress", 0) == 0);
    CHECK(body.state("pressure", 0) == 0);
    CHECK(body.ledger.failures == 1);
    CHECK(body.layout().find("plastic_strain") == nullptr);
  }
}
