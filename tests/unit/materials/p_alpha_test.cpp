// SPDX-License-Identifier: GPL-3.0-or-later
// The porous p-alpha law against its closed forms: crush curve, unloading, Hugoniot of the porous
// material, energy; alone and through the stage.
#include "krater/materials/eos/p_alpha.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "contract/material_support.hpp"
#include "krater/materials/catalogue.hpp"
#include "krater/materials/scalar_eos.hpp"

namespace {

using namespace krater;
using namespace krater::test;
using doctest::Approx;

// Aluminium of three quarters of its density, as in Herrmann's examples; p_e, p_c made up.
constexpr double kSolid = 2785, kPorous = 2089, kC0 = 5328, kS1 = 1.338, kGamma = 2.0;
constexpr double kElastic = 0.08e9, kCompact = 0.6e9;
const double kValues[] = {kSolid, kC0, kS1, kGamma, kElastic, kCompact, 2.0};
constexpr MaterialConstants kConstants{kPorous, 0.0, 294.0};

PAlpha law() { return make_law<PAlpha>(kValues, kConstants); }

/// The crush curve as printed.
double curve(double p) {
  const double alpha0 = kSolid / kPorous, left = (kCompact - p) / (kCompact - kElastic);
  return 1 + (alpha0 - 1) * left * left;
}

/// Pressure of the solid by the formula of mie_gruneisen_shock, compression only.
double solid_pressure(double rho, double e) {
  const double eta = 1 - kSolid / rho;
  const double hugoniot = kSolid * kC0 * kC0 * eta / std::pow(1 - kS1 * eta, 2);
  return hugoniot * (1 - 0.5 * kGamma * eta) + kGamma * kSolid * e;
}

Recipe porous(SpallAction action = SpallAction::limit, double spall = 0) {
  Recipe recipe{.strength = "", .eos = "p_alpha", .viscosity = false};
  recipe.parameters = {{"p_alpha.solid_density", kSolid},
                       {"p_alpha.c0", kC0},
                       {"p_alpha.S1", kS1},
                       {"p_alpha.gamma0", kGamma},
                       {"p_alpha.elastic_pressure", kElastic},
                       {"p_alpha.compaction_pressure", kCompact}};
  recipe.constants = kConstants;
  recipe.spall_strength = spall, recipe.spall_action = action;
  return recipe;
}

struct Point {
  Body body;
  explicit Point(const Recipe& recipe = porous())
      : body{*stage_factory_isa_portable(), recipe, 1, 1} {}
  void compress(double dilatation) {
    for (const int k : {0, 4, 8}) body.local("step_gradient", 0, k) = -dilatation / 3;
    body.step(1e-8);
  }
  double value(const char* field) { return body.state(field, 0); }
};

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("p-alpha: the crush curve on loading, constant alpha on unloading, no way back") {
    const PAlpha eos = law();
    const auto start = at_start(eos);
    for (const double p : {0.09e9, 0.2e9, 0.45e9, 0.59e9}) {
      CAPTURE(p);
      CHECK(eos.pores.crush(p).alpha == Approx(curve(p)).epsilon(1e-12));
      CHECK(eos.pores.crush_pressure(curve(p)) == Approx(p).epsilon(1e-10));
      const double h = 1e-4 * p;
      CHECK(eos.pores.crush(p).slope ==
            Approx((curve(p + h) - curve(p - h)) / (2 * h)).epsilon(1e-6));
      // The density at which the solid of that distension bears alpha p, by bisection.
      const double alpha = curve(p), e = 1000.0;
      double low = 0.9 * kSolid, high = 1.3 * kSolid;
      for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (low + high);
        (middle > kSolid && solid_pressure(middle, e) > alpha * p ? high : low) = middle;
      }
      const double rho = high / alpha;
      const double closed = start.after(rho, 1 / rho, e)[0];
      CHECK(closed == Approx(alpha).epsilon(1e-9));
      CHECK(pressure_at(start, rho, 1 / rho, e) == Approx(p).epsilon(1e-8));
      // From there back: the line of constant alpha.
      const auto bound = eos.at(std::array<double, 1>{closed});
      const double less = rho * 0.9999;
      CHECK(bound.after(less, 1 / less, e)[0] == closed);
      CHECK(pressure_at(bound, less, 1 / less, e) < p);
    }
    // Compacted: the solid itself; and below the elastic limit nothing closes.
    const double rho = 1.05 * kSolid;
    CHECK(start.after(rho, 1 / rho, 0.0)[0] == 1.0);
    CHECK(pressure_at(start, rho, 1 / rho, 0.0) == Approx(solid_pressure(rho, 0.0)).epsilon(1e-12));
    CHECK(start.after(kPorous * 1.0005, 1 / (kPorous * 1.0005), 0.0)[0] == eos.alpha0);
    CHECK(start.after(0.5 * kPorous, 2 / kPorous, 0.0)[0] == eos.alpha0);
  }

  TEST_CASE("p-alpha: K_s is the slope of unloading at constant entropy") {
    const PAlpha eos = law();
    const auto bound = eos.at(std::array<double, 1>{1.1});
    const double rho = 1.0001 * kSolid / 1.1, v = 1 / rho, e = 2000.0;  // below its crush pressure
    const double p = pressure_at(bound, rho, v, e), h = 1e-6;
    const auto along = [&](double factor) {
      const double r = rho * factor, dv = 1 / r - v;
      return pressure_at(bound, r, 1 / r, e - p * dv);
    };
    CHECK(bound.after(rho, v, e)[0] == 1.1);
    CHECK(bound.bulk_modulus(rho, v, p, e) ==
          Approx((along(1 + h) - along(1 - h)) / (2 * h)).epsilon(1e-6));
  }

  TEST_CASE("p-alpha: the Hugoniot of the porous material, closed form of the compacted state") {
    const auto eos = make_scalar_eos(find_law("eos", "p_alpha"), kValues, kConstants);
    for (const double up : {800.0, 2000.0, 4000.0}) {
      const ShockState s = behind_shock(*eos, up);
      CAPTURE(up);
      // p = p_s(rho, e) with e = p (1/rho00 - 1/rho)/2, and gamma rho constant.
      const double eta = 1 - kSolid / s.density;
      const double hugoniot = kSolid * kC0 * kC0 * eta / std::pow(1 - kS1 * eta, 2);
      const double exact = hugoniot * (1 - 0.5 * kGamma * eta) /
                           (1 - 0.5 * kGamma * kSolid * (1 / kPorous - 1 / s.density));
      CHECK(s.pressure > kCompact);
      CHECK(s.pressure == Approx(exact).epsilon(1e-9));
      CHECK(s.energy == Approx(0.5 * up * up).epsilon(1e-12));
    }
    // A weak one compacts in part: on the crush curve, jump conditions hold.
    const ShockState weak = behind_shock(*eos, 150.0);
    CHECK(weak.pressure < kCompact);
    CHECK(weak.pressure > kElastic);
    CHECK(weak.pressure == Approx(kPorous * weak.shock_speed * 150.0).epsilon(1e-9));
  }

  TEST_CASE("p-alpha through the stage: crushed, unloaded, its work is its energy") {
    Point point;
    double work = 0.0, p = 0.0, v = 1 / kPorous;
    const auto step = [&](double dilatation) {
      point.compress(dilatation);
      const double next = point.value("pressure"), volume = 1 / point.value("density");
      work -= 0.5 * (p + next) * (volume - v);
      p = next, v = volume;
    };
    CHECK(point.value("distension") == Approx(kSolid / kPorous).epsilon(1e-15));
    for (int i = 0; i < 4000; ++i) {
      step(1e-4);
      if (p > kElastic && p < kCompact)
        REQUIRE(point.value("distension") == Approx(curve(p)).epsilon(1e-8));
      if (p > 0.4e9) break;
    }
    CHECK(p > 0.4e9);
    CHECK(point.value("internal_energy") == Approx(work).epsilon(1e-10));
    const double alpha = point.value("distension");
    while (p > 0.0) step(-2e-5);
    CHECK(point.value("distension") == alpha);
    CHECK(point.value("internal_energy") > 0.5 * work);  // closing pores is not given back
    CHECK(point.value("internal_energy") == Approx(work).epsilon(1e-9));
    while (point.value("distension") > 1.0) step(1e-4);
    CHECK(p >= kCompact);
  }

  TEST_CASE("p-alpha with a spall that fails, and heated by its energy") {
    Point point{porous(SpallAction::fail, 0.05e9)};
    for (int i = 0; i < 100; ++i) point.compress(-1e-4);
    CHECK(point.value("failed") == 1.0);
    CHECK(point.value("pressure") == 0.0);
    CHECK(point.value("distension") == Approx(kSolid / kPorous).epsilon(1e-15));
    Recipe hot = porous();
    hot.thermal = true;
    hot.parameters["energy.c_v"] = 900.0;
    Point warm{hot};
    for (int i = 0; i < 3000; ++i) warm.compress(1e-4);
    // More heat than the isentrope of the solid: the work of closing pores, some p_e (alpha_0 - 1)/
    // rho_s at least, is 11 K here.
    const double isentrope = 294.0 * std::exp(kGamma * (1 - kSolid / warm.value("density")));
    CHECK(warm.value("distension") == 1.0);
    CHECK(warm.value("temperature") > isentrope + 11.0);
  }

  TEST_CASE("p-alpha: what is wrong is said") {
    double values[] = {2000.0, kC0, kS1, kGamma, kElastic, kCompact, 2.0};
    const int index = find_law("eos", "p_alpha");
    CHECK(std::string{law_problem(index, values, kConstants)}.find("denser than its solid") !=
          std::string::npos);
    values[0] = kSolid, values[4] = kCompact;
    CHECK(law_problem(index, values, kConstants) != nullptr);
  }
}
