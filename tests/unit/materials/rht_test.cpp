// SPDX-License-Identifier: GPL-3.0-or-later
// Riedel, Hiermaier and Thoma's concrete by its card, against rows computed apart
// (tests/data/concrete_reference.csv) and the design's B8: surfaces 1e-6, strengths of tests by
// paths of first order.
#include <doctest/doctest.h>

#include "unit/materials/card_law.hpp"
#include "unit/materials/concrete_rows.hpp"
#include "unit/materials/model_specimen.hpp"

namespace {

using namespace krater;
using namespace krater::test;
using doctest::Approx;
using Specimen = ModelSpecimen<Rht>;

Rht card(const std::string& more = "") {
  return law_of_card<Rht>("concrete_c30_37_rht", "model: {rht: {" + more + "}}");
}
Rht slow(const std::string& more = "") { return card("rate_factor: none" + more); }
constexpr RhtSurfaces::Rates<double> kSlow{1, 1};

double peak(const Rht& law, double length, auto step) {
  Specimen s{law, length};
  double most = 0;
  for (int i = 0; i < 4000 && !s.failed; ++i) {
    step(s);
    most = std::max(most, std::fabs(s.stress(0)));
  }
  return most;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("rht: failure and residual on the triaxial path") {
    const Rht c = slow();
    for (const ConcreteRow& row : concrete_rows("rht", "rht_35MPa", "triaxial_surface")) {
      CAPTURE(row["sigma3"]);
      const double x = (row["sigma3"] + row["q"] / 3) / c.f;
      const double failure = c.surfaces.failure(x, c.surfaces.meridians(x), kSlow);
      if (row.step == "failure") {
        CHECK(c.f * failure == Approx(row["q"]).epsilon(1e-6));
      } else {
        CHECK(c.f * c.surfaces.residual(x, failure) == Approx(row["q"]).epsilon(1e-6));
      }
    }
    CHECK(c.p_t == Approx(-0.0881717).epsilon(1e-6));
    CHECK(c.surfaces.meridians(0.0).Q1 == Approx(0.761661).epsilon(1e-6));
  }

  TEST_CASE("rht: surfaces have no jump, and the elastic limit lies within failure") {
    const Rht c = slow();
    for (const auto& F : {kSlow, RhtSurfaces::Rates<double>{1.4, 1.9}}) {
      for (int i = -200; i < 4000; ++i) {
        const double p = 0.001 * i, h = 1e-9;
        const auto q = c.surfaces.meridians(p);
        CHECK(std::fabs(c.surfaces.failure(p + h, q, F) - c.surfaces.failure(p - h, q, F)) < 1e-7);
        CHECK(c.surfaces.elastic(p, q, F) <= c.surfaces.failure(p, q, F) * (1 + 1e-12));
      }
      // Unconfined compression, shear and direct tension close with the rate in them.
      const auto strength = [&](double p) {
        return c.surfaces.failure(p, c.surfaces.meridians(p), F);
      };
      CHECK(strength(F.compression / 3) == Approx(F.compression).epsilon(1e-12));
      const double t = c.f_t * F.tension;
      CHECK(c.surfaces.meridians(-t / 3).Q2 * strength(-t / 3) == Approx(t).epsilon(1e-12));
    }
    const Rht fast = card();
    const auto F = fast.factors(1.0);
    CHECK(F.compression == Approx(std::pow(1 / 3e-5, 1 / (5 + 0.75 * 35))).epsilon(1e-12));
    CHECK(F.tension == Approx(std::pow(1 / 3e-6, 1 / (10 + 0.5 * 35))).epsilon(1e-12));
    CHECK(fast.factors(1e-7).compression == 1);
  }

  TEST_CASE("rht: cold hydrostat, distension, and unloading at constant distension") {
    const Rht c = slow(", B0: 0, B1: 0");
    for (const ConcreteRow& row : concrete_rows("rht", "rht_35MPa", "hydrostat")) {
      CAPTURE(row["p"]);
      Specimen s{c, 5e-3};
      const auto cold = [&](double mu, int steps) {
        const double d = (std::log1p(mu) - s.volume_strain()) / 3 / steps;
        s.strain({d * steps, d * steps, d * steps}, steps);
      };
      cold(row["mu"], 50);
      // The seventh digit of the rows' mu times K.
      CHECK(s.p == Approx(row["p"]).epsilon(1e-5));
      CHECK(s.state[1] == Approx(row["value"]).epsilon(1e-6));
      const double alpha = s.state[1], p = s.p, mu = s.mu();
      cold(mu * 0.999, 5);
      CHECK(s.state[1] == alpha);
      CHECK(s.p < p);
      cold(mu, 5);
      CHECK(s.p == Approx(p).epsilon(1e-9));
    }
  }

  TEST_CASE("rht: the whole internal energy enters the pressure") {
    const Rht c = slow();
    const double rho = 1.3 * 1.1884 * c.rho0, v = 1 / rho, e = 1e6;  // beyond all pores
    const auto at = c.at(std::array<double, 4>{0, 1, 0, 0});
    const auto u = at.update({zero_sym3<double>(), 0, 0, rho, v, e, 0, 1e-8, 5e-3});
    CHECK(u.state[1] == 1);
    CHECK(u.pressure.thermal == Approx((1.22 + 1.22 * 0.3) * rho).epsilon(1e-12));
    CHECK(u.pressure.cold ==
          Approx(0.3 * 35.27e9 + 0.09 * 39.58e9 + 0.027 * 9.04e9).epsilon(1e-12));
  }

  TEST_CASE("rht: strengths of the laboratory's tests, at first yield and at failure") {
    const Rht c = slow();
    CHECK(peak(c, 5e-3, [](Specimen& s) { s.triaxial(2e-6, 0); }) == Approx(c.f).epsilon(1e-3));
    CHECK(peak(c, 5e-3, [](Specimen& s) { s.triaxial(-2e-7, 0); }) ==
          Approx(0.1 * c.f).epsilon(1e-3));
    CHECK(peak(c, 5e-3, [](Specimen& s) { s.biaxial(2e-6, 0); }) ==
          Approx(0.913401 * c.f).epsilon(1e-3));
    Specimen sheared{c, 5e-3};
    double most = 0;
    for (int i = 0; i < 2000; ++i) {
      sheared.step({1e-6, -1e-6, 0});
      most = std::max(most, sheared.q());  // f_s is of q: a shear stress of 0.18 f/sqrt(3)
    }
    CHECK(most == Approx(0.18 * c.f).epsilon(2e-3));
    Specimen t{c, 5e-3};
    t.hydrostatic(-5e-3, 500);
    CHECK(t.p == Approx(c.p_t * c.f).epsilon(1e-9));
    // First yield: g_t of it in tension; g_c and the cap in unconfined compression.
    Specimen y{c, 5e-3};
    while (y.plastic <= 0) y.triaxial(-1e-7, 0);
    CHECK(y.q() == Approx(0.7 * 0.1 * c.f).epsilon(5e-3));
    Specimen z{c, 5e-3};
    while (z.plastic <= 0) z.triaxial(2e-6, 0);
    const double x = z.p / c.f, into = (x - 0.53 / 3) / (23.3 / 35 - 0.53 / 3);
    CHECK(z.q() ==
          Approx(0.53 * c.f * c.surfaces.failure(x / 0.53, c.surfaces.meridians(x), kSlow) *
                 std::sqrt(1 - into * into))
              .epsilon(5e-3));
  }

  TEST_CASE("rht: from the elastic limit to failure the slope is 3 xi G; then damage to friction") {
    const Rht c = slow();
    Specimen s{c, 5e-3};
    s.hydrostatic(std::expm1(0.0145), 200);  // 150 MPa: flow does not move the pressure
    while (s.plastic <= 0) s.step({1e-6, -1e-6, 0});
    const double q = s.q(), eps = s.plastic;
    CHECK(q < 0.02 * c.f);  // pores crush there: the cap has closed
    for (int i = 0; i < 100; ++i) s.step({1e-6, -1e-6, 0});
    CHECK(s.state[0] == 0);
    // The cap, which opens as it flows, is not at work: beyond where it closes sigma_e is 0.
    CHECK((s.q() - q) / (s.plastic - eps) == Approx(3 * c.xi * c.G).epsilon(1e-3));
    while (s.state[0] <= 0) s.step({1e-6, -1e-6, 0});
    const double start = s.plastic, D = s.state[0], p = s.p / c.f;
    for (int i = 0; i < 4000; ++i) s.step({1e-6, -1e-6, 0});
    CHECK(s.state[0] - D == Approx((s.plastic - start) / c.fracture_strain(p, 0.5)).epsilon(0.02));
    for (int i = 0; i < 400; ++i) s.step({1e-3, -1e-3, 0});
    CHECK(s.failed);
    const double residual = c.f * c.A_f * std::pow(s.p / c.f, c.n_f);
    CHECK(s.q() == Approx(residual * c.surfaces.meridians(s.p / c.f).Q1).epsilon(2e-3));
  }

  TEST_CASE("rht: fracture strain") {
    const Rht c = slow();
    CHECK(c.fracture_strain(0.5, 0.0) == Approx(0.04 * (0.5 + 0.0881717)).epsilon(1e-6));
    CHECK(c.fracture_strain(0.5, 1.0) == Approx(0.04 * 0.5).epsilon(1e-12));
    CHECK(c.fracture_strain(-0.05, 0.0) == 0.01);
    // Without a fracture energy tension has it too, whatever the width.
    CHECK(c.per_strain(-0.05, 0.0, 1.0) == Approx(100));
  }

  TEST_CASE("rht: with a fracture energy direct and triaxial tension dissipate it at any width") {
    const Rht c = slow(", fracture_energy: 100 J/m^2");
    for (const double length : {2.5e-3, 5e-3, 10e-3}) {
      CAPTURE(length);
      Specimen s{c, length}, t{c, length};
      const double step = 2e-8 / length;
      for (int i = 0; i < 20000 && !s.failed; ++i) s.triaxial(i < 1200 ? -1e-7 : -step, 0);
      CHECK(s.failed);
      CHECK(s.energy * c.rho0 * length == Approx(100).epsilon(0.05));
      for (int i = 0; i < 20000 && !t.failed; ++i) t.step({-step / 3, -step / 3, -step / 3});
      CHECK(t.failed);
      CHECK(t.energy * c.rho0 * length == Approx(100).epsilon(0.05));
    }
    CHECK(c.largest_length() > 0.05);
    CHECK(slow().largest_length() == 0);
  }

  TEST_CASE("rht: what is wrong is said") {
    CHECK_THROWS_WITH_AS(card("tensile_strength: 0.3"), doctest::Contains("shear_strength"),
                         InputError);
    CHECK_THROWS_WITH_AS(card("shear_strength: 0.101"), doctest::Contains("never closes"),
                         InputError);
    CHECK_THROWS_WITH_AS(card("elastic_pressure: 7 GPa"), doctest::Contains("compaction_pressure"),
                         InputError);
    CHECK_THROWS_WITH_AS(card("Q0: 0.4"), doctest::Contains("Q0"), InputError);
  }
}
