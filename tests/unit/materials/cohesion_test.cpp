// SPDX-License-Identifier: GPL-3.0-or-later
// The deviator ends where the solid of an equation of state has parted
// (materials/stages/cohesion_stage.hpp).
#include <doctest/doctest.h>

#include <cmath>

#include "contract/material_support.hpp"
#include "krater/materials/eos/split.hpp"

namespace {

using namespace krater;
using namespace krater::test;

const Recipe kVapour{.strength = "von_mises", .eos = "tillotson", .viscosity = false};

/// Equal stretches along all axes, and a shear xy, spread over `steps`.
void move(Body& body, int steps, double log_volume, double shear) {
  const double stretch = std::expm1(log_volume / (3.0 * steps));
  for (int n = 0; n < steps; ++n) {
    for (int k = 0; k < 9; ++k)
      body.local("step_gradient", 0, k) = k % 4 == 0 ? stretch : k == 1 ? shear / steps : 0.0;
    body.step(1e-9);
    REQUIRE(body.fault.kind == FaultKind::none);
  }
}

double shear_stress(Body& body) { return body.state("deviatoric_stress", 0, 5); }

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("cohesion: the deviator falls with the cold tension and does not depend on the steps") {
    for (const double x : {0.75, 0.65, 0.55}) {
      const double share = cohesion(x).share;
      double last = 0;
      for (const int steps : {20, 200}) {
        Body body{*stage_factory_isa_portable(), kVapour, 1, 1};
        move(body, 1, 0.0, 1e-3);
        const double solid = shear_stress(body);
        REQUIRE(solid == doctest::Approx(46e9 * 1e-3).epsilon(1e-3));
        move(body, steps, -std::log(0.81), 0.0);
        const double before = shear_stress(body);  // whole; the volume alone has changed b_e
        move(body, steps, -std::log(x / 0.81), 0.0);
        CHECK(body.state("density", 0) == doctest::Approx(x * 8960.0).epsilon(1e-9));
        CHECK(shear_stress(body) == doctest::Approx(share * before).epsilon(1e-3));
        if (last != 0) CHECK(shear_stress(body) == doctest::Approx(last).epsilon(1e-3));
        last = shear_stress(body);
      }
    }
  }

  TEST_CASE("cohesion: what has parted carries no shear, flows without work, and is solid again") {
    Body body{*stage_factory_isa_portable(), kVapour, 1, 1};
    move(body, 1, 0.0, 0.05);
    const double yield = std::sqrt(3.0) * shear_stress(body);
    CHECK(yield > 9e7);
    move(body, 50, std::log(2.5), 0.0);  // x = 0.4
    CHECK(shear_stress(body) == 0.0);
    const double work = body.ledger.plastic_work, e = body.state("internal_energy", 0);
    move(body, 50, 0.0, 1.0);
    CHECK(shear_stress(body) == 0.0);
    CHECK(body.ledger.plastic_work == doctest::Approx(work).epsilon(1e-12));
    CHECK(body.state("internal_energy", 0) == e);
    move(body, 50, -std::log(2.5), 0.0);
    CHECK(std::fabs(shear_stress(body)) < 1e-6 * yield);
    move(body, 1, 0.0, 0.05);
    CHECK(std::sqrt(3.0) * shear_stress(body) > 0.9 * yield);
  }

  TEST_CASE("cohesion: the work of the step is that of the carried stress") {
    for (const char* damage : {"", "maximum_plastic_strain"}) {
      Recipe recipe = kVapour;
      recipe.damage = damage;
      recipe.parameters = {{"maximum_plastic_strain.eps_max", 100.0}};
      Body body{*stage_factory_isa_portable(), recipe, 1, 1};
      move(body, 1, 0.0, 0.05);
      move(body, 20, -std::log(0.72), 0.0);
      // Shear alone does no work on the pressure: e rises by what the carried shear stress does.
      double work = 0;
      for (int n = 0; n < 100; ++n) {
        const double before = shear_stress(body), e = body.state("internal_energy", 0);
        move(body, 1, 0.0, 1e-3);
        const double expected =
            0.5 * (before + shear_stress(body)) * 1e-3 / body.state("density", 0);
        CHECK(body.state("internal_energy", 0) - e == doctest::Approx(expected).epsilon(2e-3));
        work += expected;
      }
      CHECK(work > 0);
    }
  }
}
