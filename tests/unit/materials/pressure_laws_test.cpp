// SPDX-License-Identifier: GPL-3.0-or-later
// Laws that read the pressure, through their stages: a varying shear modulus, dilatancy, the apex.
#include <doctest/doctest.h>

#include <cmath>

#include "contract/material_support.hpp"
#include "krater/materials/returns/trial_deviator.hpp"
#include "krater/materials/strength/steinberg_guinan.hpp"

namespace {

using namespace krater;
using namespace krater::test;

constexpr double kK = 139e9;  // linear equation of state of the typical parameters

Body make(const char* strength) {
  return Body{*stage_factory_isa_portable(),
              {.strength = strength, .eos = "linear", .viscosity = false},
              1,
              1};
}

/// One step with a diagonal dt L and a shear xy.
void step(Body& body, double volume, double shear) {
  for (const int k : {0, 4, 8}) body.local("step_gradient", 0, k) = volume / 3.0;
  body.local("step_gradient", 0, 1) = shear;
  body.step(1e-8);
}

double q_of(Body& body) {
  double sum = 0.0;
  for (int k = 0; k < 6; ++k) {
    const double s = body.state("deviatoric_stress", 0, k);
    sum += (k < 3 ? 1.0 : 2.0) * s * s;
  }
  return std::sqrt(1.5 * sum);
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE(
      "Steinberg-Guinan: the stress is kept when the modulus changes, the trial uses the new one") {
    Body body = make("steinberg_guinan");
    const auto values = typical_parameters(
        catalogue().at(static_cast<std::size_t>(find_law("strength", "steinberg_guinan"))));
    const auto law = make_law<SteinbergGuinan>(values.data(), kCopper);
    step(body, 0.0, 5e-4);  // elastic: q = sqrt(3) G 5e-4 = 40 MPa
    const double G0 = kCopper.shear_modulus * (1.0 - 3.77e-4 * (294.0 - 300.0));
    CHECK(body.local("shear_modulus", 0) == doctest::Approx(G0).epsilon(1e-14));
    CHECK(body.state("deviatoric_stress", 0, 5) == doctest::Approx(5e-4 * G0).epsilon(1e-12));
    for (int n = 0; n < 200; ++n) step(body, -1e-3, 0.0);  // spherical: the deviator is frozen
    CHECK(body.state("deviatoric_stress", 0, 5) == doctest::Approx(5e-4 * G0).epsilon(1e-10));
    const double p = body.state("pressure", 0), x = body.state("density", 0) / kCopper.density;
    const double G1 = law.shear_modulus(294.0, p, x);
    CHECK(G1 > 1.7 * G0);
    step(body, 0.0, -5e-4);
    CHECK(body.local("shear_modulus", 0) == doctest::Approx(G1).epsilon(1e-14));
    // The rate form: what is left is (G0 - G1) of the strain (theory 13: exact in one step).
    CHECK(body.state("deviatoric_stress", 0, 5) == doctest::Approx(5e-4 * (G0 - G1)).epsilon(1e-5));
    CHECK(body.state("plastic_strain", 0) == 0.0);
  }

  TEST_CASE("Steinberg-Guinan: the energy is the work of the stresses carried") {
    Body body = make("steinberg_guinan");
    double work = 0.0;
    for (int n = 0; n < 400; ++n) {
      const double volume = n < 200 ? -5e-4 : 5e-4;
      const double p = body.state("pressure", 0), v = 1.0 / body.state("density", 0);
      step(body, volume, 1e-4 * std::sin(0.05 * n));
      const double v1 = 1.0 / body.state("density", 0);
      work += body.local("specific_work", 0) - 0.5 * (p + body.state("pressure", 0)) * (v1 - v);
    }
    CHECK(body.fault.kind == FaultKind::none);
    CHECK(body.state("plastic_strain", 0) > 1e-3);
    CHECK(body.state("internal_energy", 0) == doctest::Approx(work).epsilon(1e-10));
  }

  TEST_CASE("Drucker-Prager: yield follows the pressure; no tension beyond the apex") {
    Body body = make("drucker_prager");
    for (const double p_wanted : {0.0, 2e9, 8e9}) {
      while (body.state("pressure", 0) < p_wanted) step(body, -1e-3, 0.0);
      double p = 0.0;
      for (int n = 0; n < 30; ++n) {
        p = body.state("pressure", 0);
        step(body, 0.0, 5e-3);
      }
      CHECK(q_of(body) == doctest::Approx(100e6 + 0.6 * p).epsilon(1e-10));
    }
    Body pulled = make("drucker_prager");
    double work = 0.0;
    for (int n = 0; n < 100; ++n) {
      const double p = pulled.state("pressure", 0), v = 1.0 / pulled.state("density", 0);
      step(pulled, n < 60 ? 1e-4 : -1e-4, 1e-5);
      const double v1 = 1.0 / pulled.state("density", 0);
      work += pulled.local("specific_work", 0) - 0.5 * (p + pulled.state("pressure", 0)) * (v1 - v);
      CHECK(pulled.state("pressure", 0) >= -100e6 / 0.6);
      if (n == 50) {
        CHECK(pulled.state("pressure", 0) == doctest::Approx(-100e6 / 0.6).epsilon(1e-14));
        CHECK(q_of(pulled) < 1e-15 * 100e6);  // Y + alpha p to round-off
      }
    }
    CHECK(pulled.fault.kind == FaultKind::none);
    CHECK(pulled.state("internal_energy", 0) == doctest::Approx(work).epsilon(1e-10));
  }

  TEST_CASE("Drucker-Prager: dilatancy raises the confined pressure by K b d, up to the limit") {
    Body body = make("drucker_prager");
    while (body.state("pressure", 0) < 1e9) step(body, -1e-4, 0.0);
    const double v = 1.0 / body.state("density", 0);
    double limit = 0.0;
    for (int n = 0; n < 2000; ++n) {
      const double voids = body.state("void_volume", 0);
      step(body, 0.0, 1e-3);
      const double eps = body.state("plastic_strain", 0);
      // Solid specific volume v - voids, p = K (v0/(v - voids) - 1).
      const double solid = v - body.state("void_volume", 0);
      CHECK(body.state("pressure", 0) ==
            doctest::Approx(kK * (1.0 / (kCopper.density * solid) - 1.0)).epsilon(1e-9));
      if (voids < 0.05 * v)
        CHECK(body.state("void_volume", 0) == doctest::Approx(0.2 * eps * v).epsilon(1e-9));
      limit = body.state("void_volume", 0) / v;
      CHECK(body.local("plastic_work", 0) >= 0.0);
    }
    CHECK(limit >= 0.05);
    CHECK(limit < 0.05 + 0.2 * 1e-3);
    CHECK(body.state("density", 0) == doctest::Approx(1.0 / v).epsilon(1e-12));
  }
}
