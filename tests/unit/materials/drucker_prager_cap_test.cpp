// SPDX-License-Identifier: GPL-3.0-or-later
// Drucker and Prager's concrete, with and without a cap, against rows computed apart
// (tests/data/concrete_reference.csv). Implicit steps of first order: 1e-5 strain per step, 1e-3.
#include <doctest/doctest.h>

#include "unit/materials/card_law.hpp"
#include "unit/materials/concrete_rows.hpp"
#include "unit/materials/model_specimen.hpp"

namespace {

using namespace krater;
using namespace krater::test;
using doctest::Approx;
using Specimen = ModelSpecimen<DruckerPragerCap>;

DruckerPragerCap law(const std::string& more = "") {
  return law_of<DruckerPragerCap>(
      "density: 2243, youngs_modulus: 29.67 GPa, poisson_ratio: 0.2, model: {drucker_prager: "
      "{compressive_strength: 39.3 MPa, tensile_strength: 3.93 MPa, air_voids: 0.113" +
      more + "}}");
}
std::vector<ConcreteRow> rows(const char* path) {
  return concrete_rows("dp_cap", "dp_39.30MPa", path);
}
/// Strength in triaxial compression, after `strain`.
double strength(const DruckerPragerCap& law, double lateral, double strain) {
  Specimen s{law};
  if (lateral > 0)
    for (int i = 1; i <= 50; ++i) s.hydrostatic_to_pressure(lateral * i / 50);
  const int steps = 4000;
  for (int i = 0; i < steps; ++i) s.triaxial(strain / steps, lateral);
  return s.q();
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("drucker_prager: constants from the two strengths") {
    const DruckerPragerCap dp = law();
    CHECK(dp.problem() == nullptr);
    const double expected[] = {dp.K, dp.G, dp.alpha, dp.k, dp.hardening.X0, dp.f, dp.hardening.D1};
    const auto constants = rows("constants");
    for (std::size_t i = 0; i < constants.size(); ++i) {
      CAPTURE(constants[i].step);
      CHECK(expected[i] == Approx(constants[i]["value"]).epsilon(1e-6));
    }
  }

  TEST_CASE("drucker_prager: hydrostat, its unloading, and the cap that stays") {
    for (const ConcreteRow& row : rows("hydrostat")) {
      CAPTURE(row["p"]);
      Specimen s{law()};
      s.hydrostatic(std::expm1(row["eps_v"]), 400);
      // The rows give strain with seven digits; K times the last of them is 1e-6 of p.
      CHECK(s.p == Approx(row["p"]).epsilon(3e-6));
      CHECK(std::fabs(s.state[0] - row["eps_c"]) < 2e-6 * row["eps_v"]);
      const double K = s.law.K, p = s.p, back = 0.5 * p / K;
      s.strain({-back / 3, -back / 3, -back / 3}, 10);
      CHECK(s.p == Approx(0.5 * p).epsilon(1e-12));
      s.strain({back / 3, back / 3, back / 3}, 10);
      CHECK(s.p == Approx(p).epsilon(1e-6));  // 2^-24 of the width of the cap
    }
  }

  TEST_CASE("drucker_prager: uniaxial strain") {
    Specimen s{law()};
    for (const ConcreteRow& row : rows("uniaxial_strain")) {
      if (!row.has("p")) continue;
      CAPTURE(row["eps1"]);
      const double way = row["eps1"] - s.eps[0];
      s.strain({way, 0, 0}, static_cast<int>(way / 1e-5 + 0.5));
      CHECK(s.p == Approx(row["p"]).epsilon(1e-3));
      CHECK(s.q() == Approx(row["q"]).epsilon(1e-3));
      CHECK(std::fabs(s.state[0] - row["eps_c"]) < 1e-3 * row["eps_c"] + 1e-9);
      CHECK(std::fabs(s.plastic - row["eps_p"]) < 1e-2 * row["eps_p"] + 1e-9);
    }
  }

  TEST_CASE("drucker_prager: triaxial strength with the cap, and the line without") {
    const auto capped = rows("triaxial_strength"), line = rows("triaxial_surface");
    for (std::size_t i = 0; i < 4; ++i) {
      CAPTURE(capped[i]["sigma3"]);
      CHECK(strength(law(), capped[i]["sigma3"], 0.2) == Approx(capped[i]["q"]).epsilon(1e-3));
      // Without a cap: elastic to the line, which a step of 5e-5 meets exactly.
      CHECK(strength(law(", cap: none"), line[i]["sigma3"], 0.2) ==
            Approx(line[i]["q"]).epsilon(1e-6));
    }
  }

  TEST_CASE("drucker_prager: triaxial path at 10 MPa; unconfined with associated flow") {
    Specimen s{law()};
    s.hydrostatic_to_pressure(10e6);
    for (const ConcreteRow& row : rows("triaxial")) {
      CAPTURE(row["eps1"]);
      while (s.eps[0] < row["eps1"] - 1e-12)
        s.triaxial(std::min(4e-6, row["eps1"] - s.eps[0]), 10e6);
      CHECK(s.q() == Approx(row["q"]).epsilon(2e-3));
      CHECK(s.volume_strain() == Approx(row["eps_v"]).epsilon(5e-3));
    }
    // The rows are called "dilatancy 0" in the table; their volume is that of associated flow,
    // d eps_v = -13.5 d eps_1.
    Specimen u{law(", dilatancy: 1")};
    for (const ConcreteRow& row : rows("unconfined")) {
      if (row["eps1"] > 0.006) break;
      while (u.eps[0] < row["eps1"] - 1e-12) u.triaxial(1e-5, 0);
      CHECK(u.q() == Approx(row["q"]).epsilon(1e-6));
      CHECK(u.volume_strain() == Approx(row["eps_v"]).epsilon(2e-3));
      CHECK(u.plastic == Approx(row["eps_p"]).epsilon(2e-3));
    }
  }

  TEST_CASE("drucker_prager: direct tension gives f_t, the apex parts and closes again") {
    Specimen s{law()};
    for (int i = 0; i < 100; ++i) s.triaxial(-5e-6, 0);
    CHECK(s.q() == Approx(3.93e6).epsilon(1e-3));
    Specimen open{law()};
    const double apex = -law().k / law().alpha / 3;
    open.hydrostatic(-0.01, 100);
    CHECK(open.p == Approx(apex).epsilon(1e-12));
    open.hydrostatic(-1e-9, 100);
    CHECK(std::fabs(open.p) < 100);
    CHECK(std::fabs(open.energy) < 1e-6 * 0.01 * -apex / open.law.rho0);
  }

  TEST_CASE("drucker_prager: what is wrong between parameters is said") {
    CHECK_THROWS_WITH_AS(law(", lock_pressure: 20 MPa"), doctest::Contains("first cap"),
                         InputError);
    CHECK_THROWS_WITH_AS(
        law_of<DruckerPragerCap>("density: 2243, shear_modulus: 10 GPa, bulk_modulus: 10 GPa, "
                                 "model: {drucker_prager: {compressive_strength: 30 MPa, "
                                 "tensile_strength: 40 MPa}}"),
        doctest::Contains("below compressive_strength"), InputError);
  }
}
