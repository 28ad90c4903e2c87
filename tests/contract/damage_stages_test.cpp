// SPDX-License-Identifier: GPL-3.0-or-later
// Damage, failure and spall through the real stages: what is carried, and that it does the work.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "material_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

constexpr double E = 200e9, nu = 0.3, K = E / (3.0 * (1.0 - 2.0 * nu)), G = E / (2.0 * (1.0 + nu));

/// The steel of theory D10, Y = 300 MPa, S = 2 MPa.
Recipe steel(const char* damage = "lemaitre_energy") {
  return {.strength = "von_mises",
          .eos = "linear",
          .viscosity = false,
          .damage = damage,
          .parameters = {{"von_mises.Y", 300e6},
                         {"von_mises.H", 0.0},
                         {"linear.bulk_modulus", K},
                         {"lemaitre_energy.S", 2e6},
                         {"lemaitre_energy.eps_d", 0.0},
                         {"lemaitre_energy.phi_c", 0.999},
                         {"maximum_plastic_strain.eps_max", 0.004}},
          .constants = {7850.0, G, 294.0}};
}

/// One point along a path of stretches (l_x, l_y = l_z), with the work of the carried stresses.
struct Driver {
  explicit Driver(const Recipe& recipe) : body{*stage_factory_isa_portable(), recipe, 1, 1} {}

  double value(const char* field, int k = 0) { return body.state(field, 0, k); }
  bool has(const char* field) const { return body.layout().find(field) != nullptr; }

  void step(double x_factor, double y_factor = 1.0) {
    const double v0 = 1.0 / value("density"), p0 = value("pressure"),
                 s0 = value("deviatoric_stress");
    const double t0 = value("deviatoric_stress", 1) + value("deviatoric_stress", 2);
    body.local("step_gradient", 0, 0) = x_factor - 1.0;
    body.local("step_gradient", 0, 4) = body.local("step_gradient", 0, 8) = y_factor - 1.0;
    body.step(1e-8);
    const double v1 = 1.0 / value("density");
    const double dx = 2.0 * (x_factor - 1.0) / (x_factor + 1.0),
                 dy = 2.0 * (y_factor - 1.0) / (y_factor + 1.0);
    const double t1 = value("deviatoric_stress", 1) + value("deviatoric_stress", 2);
    work += -0.5 * (p0 + value("pressure")) * (v1 - v0) +
            0.25 * (v0 + v1) * ((s0 + value("deviatoric_stress")) * dx + (t0 + t1) * dy);
    traffic += std::fabs(0.5 * (p0 + value("pressure")) * (v1 - v0));
  }
  void to(double strain, int steps) {
    for (int i = 0; i < steps; ++i) step(std::pow((1.0 + strain) / now, 1.0 / steps));
    now = 1.0 + strain;
  }

  Body body;
  double work = 0.0, traffic = 0.0, now = 1.0;
};

/// phi of uniaxial strain at finite strain, by quadrature: q~ = Y after yield, p~ = K (1/l - 1),
/// K_s = K/l, and b_e stays what it was at yield: d eps = (4 l0^(4/3) + 2 l0^(-2/3))/9 d ln l.
double reference_damage(double end) {
  const double Y = 300e6, S = 2e6;
  double l0 = 1.0;
  for (int i = 0; i < 50; ++i)  // G (l^(4/3) - l^(-2/3)) = Y
    l0 -= (G * (std::pow(l0, 4.0 / 3.0) - std::pow(l0, -2.0 / 3.0)) - Y) / (2.0 * G);
  const double plastic = (4.0 * std::pow(l0, 4.0 / 3.0) + 2.0 * std::pow(l0, -2.0 / 3.0)) / 9.0;
  const int n = 4000;
  double phi = 0.0;
  for (int i = 0; i < n; ++i) {
    const double l = l0 + (1.0 + end - l0) * (i + 0.5) / n, Ks = K / l;
    const double chi = K * (1.0 - 1.0 / l) / Y, modulus = 9.0 * Ks * G / (3.0 * Ks + G);
    const double R = (3.0 * Ks + 9.0 * G * chi * chi) / (3.0 * Ks + G);
    phi += Y * Y * R / (2.0 * modulus * S) * plastic * (1.0 + end - l0) / n / l;
  }
  return phi;
}

}  // namespace

TEST_SUITE("contract") {
  TEST_CASE("damage: Lemaitre in uniaxial strain through the stages, first order in the step") {
    // The closed form of D10 (.009714, .075179) is of small strain: 1 % and 4 % away.
    CHECK(std::fabs(reference_damage(0.01) - 0.009714) < 0.02 * 0.009714);
    CHECK(std::fabs(reference_damage(0.02) - 0.075179) < 0.05 * 0.075179);
    for (const double strain : {0.01, 0.02}) {
      double error[2];
      for (int level = 0; level < 2; ++level) {
        Driver driver{steel()};
        driver.to(strain, 1000 << level);
        error[level] = std::fabs(driver.value("damage") - reference_damage(strain));
      }
      CHECK(error[1] < 3e-3 * reference_damage(strain));
      CHECK(error[0] / error[1] == doctest::Approx(2.0).epsilon(0.1));
    }
  }

  TEST_CASE(
      "damage: carried stresses are (1 - phi) of the effective ones; pressure by Decision 6") {
    for (const DegradePressure mode :
         {DegradePressure::tension, DegradePressure::none, DegradePressure::all}) {
      CAPTURE(static_cast<int>(mode));
      Recipe recipe = steel();
      recipe.degrade = mode;
      Driver driver{recipe};
      driver.to(0.02, 800);
      const double phi = driver.value("damage");
      CHECK(phi > 0.05);
      const double q = 1.5 * driver.value("deviatoric_stress");
      CHECK(q == doctest::Approx((1.0 - phi) * 300e6).epsilon(1e-9));
      const double effective = K * (driver.value("density") / 7850.0 - 1.0);
      const double w = mode == DegradePressure::none ? 1.0 : 1.0 - phi;
      CHECK(driver.value("pressure") == doctest::Approx(w * effective).epsilon(1e-10));
      driver.to(-0.02, 800);
      const double compressed = K * (driver.value("density") / 7850.0 - 1.0);
      const double c = mode == DegradePressure::all ? 1.0 - driver.value("damage") : 1.0;
      CHECK(driver.value("pressure") == doctest::Approx(c * compressed).epsilon(1e-10));
    }
  }

  TEST_CASE("damage: a tension cycle with growing damage, failure and spall closes its energy") {
    Recipe spalling = steel();
    spalling.spall_strength = 2e9;
    Recipe hot = steel("johnson_cook");
    hot.strength = "johnson_cook", hot.eos = "mie_gruneisen_shock", hot.heating = true;
    Recipe rate = steel();
    rate.coupling = Coupling::rate;
    Recipe all = steel();
    all.degrade = DegradePressure::all;
    Recipe guinan = steel();
    guinan.strength = "steinberg_guinan", guinan.heating = true;
    Recipe rock = steel(), rock_rate = rate;
    rock.strength = rock_rate.strength = "drucker_prager";
    Recipe thermal = hot;
    thermal.heating = false, thermal.thermal = true;
    for (const Recipe& recipe : {steel(), spalling, hot, rate, all, guinan, rock, rock_rate,
                                 thermal, steel("maximum_plastic_strain")}) {
      CAPTURE(describe(recipe));
      Driver driver{recipe};
      double last = 0.0;
      for (const double strain : {0.02, 0.0, 0.04, -0.03, 0.15, 0.0}) {
        driver.to(strain, 300);
        CHECK(std::fabs(driver.value("internal_energy") - driver.work) < 1e-12 * driver.traffic);
        // A closed cycle only costs, until nothing that dissipates is left.
        if (strain == 0.0 && driver.value("failed") == 0.0) CHECK(driver.work > last);
        if (strain == 0.0) last = driver.work;
      }
      REQUIRE(driver.body.fault.kind == FaultKind::none);
      if (recipe.spall_strength > 0) CHECK(driver.body.ledger.spalls > 0);
    }
  }

  TEST_CASE(
      "damage: Drucker-Prager yields at (1 - phi)(Y + alpha p~) and separates at w times its "
      "apex") {
    for (const Coupling coupling : {Coupling::effective, Coupling::rate}) {
      Recipe recipe = steel("lemaitre_energy");
      recipe.strength = "drucker_prager", recipe.coupling = coupling;
      recipe.parameters["drucker_prager.Y"] = 500e6;
      recipe.parameters["drucker_prager.dilatancy"] = 0.0;
      recipe.parameters["lemaitre_energy.S"] = 0.05e6;
      recipe.parameters["lemaitre_energy.triaxiality_min"] = -100.0;
      Driver driver{recipe};
      const auto shear = [&](double by, double volume) {
        for (int k = 0; k < 9; ++k)
          driver.body.local("step_gradient", 0, k) = k == 1 ? by : k % 4 == 0 ? volume : 0.0;
        driver.body.step(1e-8);
      };
      double p = 0.0;
      while (driver.value("damage") < 0.4) p = driver.value("pressure"), shear(1e-4, -2e-6);
      REQUIRE(driver.value("failed") == 0.0);
      CHECK(p > 0.0);
      const double phi = driver.value("damage");
      double square = 0.0;
      for (int k = 0; k < 6; ++k)
        square += (k < 3 ? 1.0 : 2.0) * std::pow(driver.value("deviatoric_stress", k), 2);
      // Compression is not degraded: p^ = p~.
      CHECK(std::sqrt(1.5 * square) ==
            doctest::Approx((1.0 - phi) * (500e6 + 0.6 * p)).epsilon(1e-9));
      for (int n = 0; n < 3000; ++n) shear(0.0, 2e-5);
      REQUIRE(driver.value("failed") == 0.0);
      CHECK(driver.value("pressure") ==
            doctest::Approx(-(1.0 - driver.value("damage")) * 500e6 / 0.6).epsilon(1e-12));
      REQUIRE(driver.body.fault.kind == FaultKind::none);
    }
  }

  TEST_CASE("rates: Steinberg-Guinan's modulus of the step enters every rate") {
    for (const Rate rate : {Rate::truesdell_projected, Rate::jaumann, Rate::green_naghdi}) {
      const Recipe recipe{
          .strength = "steinberg_guinan", .eos = "linear", .viscosity = false, .rate = rate};
      Body body{*stage_factory_isa_portable(), recipe, 1, 1};
      const auto step = [&](double volume, double shear) {
        for (int k = 0; k < 9; ++k)
          body.local("step_gradient", 0, k) = k == 1 ? shear : k % 4 == 0 ? volume : 0.0;
        body.step(1e-8);
      };
      for (int n = 0; n < 200; ++n) step(-3e-4, 0.0);
      const double p = body.state("pressure", 0), x = body.state("density", 0) / 8960.0;
      const double G = 46e9 * (1.0 + 2.83e-11 * p / std::cbrt(x) - 3.77e-4 * (294.0 - 300.0));
      CHECK(G > 1.2 * 46e9);
      step(0.0, 1e-4);
      CHECK(body.local("shear_modulus", 0) == doctest::Approx(G).epsilon(1e-13));
      CHECK(body.state("deviatoric_stress", 0, 5) == doctest::Approx(1e-4 * G).epsilon(1e-4));
      CHECK(body.state("plastic_strain", 0) == 0.0);
    }
  }

  TEST_CASE("failure: no deviator, no tension, its energy stays as heat; pressure on re-closure") {
    Driver driver{steel("maximum_plastic_strain")};
    double before = 0.0;
    int steps = 0;
    while (driver.value("failed") == 0.0 && steps++ < 1000) {
      before = driver.value("pressure");
      driver.step(1.0 + 2e-5);
    }
    CHECK(driver.value("plastic_strain") == doctest::Approx(0.004).epsilon(0.01));
    CHECK(driver.value("damage") == 1.0);
    CHECK(before < -0.5e9);
    CHECK(driver.value("pressure") == 0.0);
    for (int k = 0; k < 6; ++k) CHECK(driver.value("deviatoric_stress", k) == 0.0);
    CHECK(driver.body.local("shear_modulus", 0) == 0.0);
    CHECK(driver.body.ledger.failures == 1.0);
    const double released = driver.value("internal_energy");
    CHECK(released > 0.45 * before * before / (K * 7850.0));
    const double eps = driver.value("plastic_strain");
    for (int i = 0; i < 400; ++i) driver.step(1.01);  // flies apart, to 50 times its volume
    CHECK(driver.value("internal_energy") == released);
    CHECK(driver.value("plastic_strain") == eps);
    CHECK(driver.body.local("plastic_work", 0) == 0.0);
    for (int i = 0; i < 400; ++i) driver.step(1.0 / 1.01);
    for (int i = 0; i < 600; ++i) driver.step(1.0 - 2e-5);
    CHECK(driver.value("pressure") > 0.1e9);
    CHECK(driver.value("deviatoric_stress") == 0.0);
    CHECK(driver.body.ledger.failures == 1.0);
    REQUIRE(driver.body.fault.kind == FaultKind::none);
  }

  TEST_CASE("failure: Lemaitre fails at phi_c, having released what it had left") {
    Recipe recipe = steel();
    recipe.parameters["lemaitre_energy.phi_c"] = 0.5;
    for (const Coupling coupling : {Coupling::effective, Coupling::rate}) {
      recipe.coupling = coupling;
      Driver driver{recipe};
      int steps = 0;
      while (driver.value("failed") == 0.0 && steps++ < 4000) driver.step(1.0 + 2e-5);
      CHECK(driver.value("damage") == 0.5);
      CHECK(driver.value("pressure") == 0.0);
      CHECK(driver.value("deviatoric_stress") == 0.0);
      CHECK(std::fabs(driver.value("internal_energy") - driver.work) < 1e-12 * driver.traffic);
    }
  }

  TEST_CASE("coupling rate: snap-back fails the point and is counted") {
    Recipe recipe = steel("lemaitre_threshold");
    recipe.coupling = Coupling::rate;
    recipe.parameters["lemaitre_threshold.e_F"] = 0.0021;
    recipe.parameters["lemaitre_threshold.e_D"] = 0.0005;
    recipe.parameters["lemaitre_threshold.phi_c"] = 0.99;
    Driver driver{recipe};
    int steps = 0;
    double phi = 0.0;
    while (driver.value("failed") == 0.0 && steps++ < 2000) {
      phi = driver.value("damage");
      driver.step(1.0 + 1e-5);
    }
    CHECK(phi < 0.97);  // softening outruns 3G (1 - phi) before phi_c
    CHECK(driver.body.ledger.snap_backs == 1.0);
    CHECK(driver.body.ledger.failures == 1.0);
    driver.to(0.05, 100);
    CHECK(driver.body.ledger.snap_backs == 1.0);
    REQUIRE(driver.body.fault.kind == FaultKind::none);
    // Hardening so steep that the step has a root below phi_c: it fails for the snap-back alone.
    recipe.parameters["von_mises.H"] = 500e9;
    Driver steep{recipe};
    steps = 0;
    while (steep.value("failed") == 0.0 && steps++ < 2000) steep.step(1.0 + 1e-5);
    CHECK(steep.value("damage") < 0.9);
    CHECK(steep.body.ledger.snap_backs == 1.0);
    CHECK(steep.value("deviatoric_stress") == 0.0);
  }

  TEST_CASE(
      "spall: tension ends at the strength, every cut-off is counted, nothing in compression") {
    for (const char* eos : {"linear", "mie_gruneisen_shock"}) {
      Recipe recipe{.strength = "", .eos = eos, .viscosity = false, .spall_strength = 1e9};
      Body body{*stage_factory_isa_portable(), recipe, 1, 1};
      double cut = 0.0;
      for (int i = 0; i < 100; ++i) {
        body.local("step_gradient", 0, 0) = i < 60 ? 5e-4 : -1e-3;
        body.step(1e-8);
        CHECK(body.state("pressure", 0) >= -1e9);
        if (body.state("pressure", 0) == -1e9) cut += 1.0;
      }
      CHECK(cut > 10.0);
      CHECK(body.ledger.spalls == cut);
      CHECK(body.state("pressure", 0) > 0.5e9);
    }
  }

  TEST_CASE("spall that fails: the point parts once, keeps the energy, bears compression only") {
    for (const char* strength : {"", "elastic", "von_mises"}) {
      CAPTURE(strength);
      Recipe recipe{.strength = strength,
                    .eos = "mie_gruneisen_shock",
                    .viscosity = false,
                    .spall_strength = 1e9,
                    .spall_action = SpallAction::fail};
      Body body{*stage_factory_isa_portable(), recipe, 1, 1};
      const auto stretch = [&](double by) {
        body.local("step_gradient", 0, 0) = by;
        body.step(1e-8);
      };
      double before = 0.0;
      int steps = 0;
      while (body.state("failed", 0) == 0.0 && steps++ < 200) {
        before = body.state("pressure", 0);
        stretch(1e-4);
      }
      CHECK(before == doctest::Approx(-1e9).epsilon(0.03));  // the strength, but for a step
      CHECK(before > -1e9);
      CHECK(body.state("pressure", 0) == 0.0);
      CHECK(body.ledger.spalls == 1.0);
      CHECK(body.ledger.failures == 1.0);
      stretch(1e-4);  // the deviator follows in this step
      const double energy = body.state("internal_energy", 0);
      CHECK(energy > 0.0);
      for (int i = 0; i < 50; ++i) {
        stretch(1e-3);
        CHECK(body.state("pressure", 0) == 0.0);
        if (*strength != 0) CHECK(body.state("deviatoric_stress", 0) == 0.0);
      }
      CHECK(body.state("internal_energy", 0) >= 0.9 * energy);  // what it had stored is heat now
      CHECK(body.state("internal_energy", 0) <= energy * (1.0 + 1e-12));
      for (int i = 0; i < 80; ++i) stretch(-1e-3);
      CHECK(body.state("pressure", 0) > 1e8);  // closed again
      CHECK(body.ledger.spalls == 1.0);
    }
  }

  TEST_CASE("damage that has not begun changes no bit of the stress") {
    for (const char* strength :
         {"von_mises", "johnson_cook", "steinberg_guinan", "drucker_prager"}) {
      Recipe sound{.strength = strength, .eos = "mie_gruneisen_shock", .heating = true};
      Recipe damaged = sound;
      damaged.damage = "maximum_plastic_strain";
      damaged.parameters["maximum_plastic_strain.eps_max"] = 1e9;
      Recipe waiting = sound;
      waiting.damage = "lemaitre_energy";
      waiting.parameters["lemaitre_energy.eps_d"] = 1e9;
      Body a{*stage_factory_isa_portable(), sound, 20, 20};
      Body b{*stage_factory_isa_portable(), damaged, 20, 20};
      Body c{*stage_factory_isa_portable(), waiting, 20, 20};
      CHECK(a.layout().find("damage") == nullptr);
      CHECK(a.layout().find("failed") == nullptr);
      for (int n = 0; n < 20; ++n) {
        for (Body* body : {&a, &b, &c}) {
          set_motion(*body, n, 1e-3);
          body->step(1e-8);
        }
      }
      for (int i = 0; i < 20; ++i) {
        for (const char* field : {"pressure", "internal_energy", "plastic_strain", "temperature"}) {
          CHECK(a.state(field, i) == b.state(field, i));
          CHECK(a.state(field, i) == c.state(field, i));
        }
        for (int k = 0; k < 6; ++k) {
          CHECK(a.state("deviatoric_stress", i, k) == b.state("deviatoric_stress", i, k));
          CHECK(a.state("deviatoric_stress", i, k) == c.state("deviatoric_stress", i, k));
        }
      }
    }
  }

  TEST_CASE("materials: a copy of the state columns continues with the same bits") {
    for (const Recipe& recipe : all_recipes()) {
      CAPTURE(describe(recipe));
      Body whole{*stage_factory_isa_portable(), recipe, 13, 13};
      for (int n = 0; n < 12; ++n) {
        set_motion(whole, n, 1e-3);
        whole.step(1e-8);
      }
      Body resumed{*stage_factory_isa_portable(), recipe, 13, 13};
      for (const Column& c : whole.layout().columns()) {
        for (int i = 0; i < 13; ++i) {
          for (int k = 0; k < c.components; ++k)
            resumed.state(c.field->name, i, k) = whole.state(c.field->name, i, k);
        }
      }
      for (int n = 12; n < 24; ++n) {
        for (Body* body : {&whole, &resumed}) {
          set_motion(*body, n, 1e-3);
          body->step(1e-8);
        }
      }
      for (int i = 0; i < 13; ++i) CHECK(whole.everything(i) == resumed.everything(i));
    }
  }
}
