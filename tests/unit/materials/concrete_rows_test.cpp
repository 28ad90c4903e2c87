// SPDX-License-Identifier: GPL-3.0-or-later
// Every card of concrete by Holmquist, Johnson and Cook against rows computed apart (quadrature and
// closed forms, tests/data/concrete_reference.csv). Hydrostats and surfaces 1e-6: the rows have
// seven digits. Paths are strain-driven, explicit in the damage, so of first order: 2e-6 strain per
// step, 1e-4, and 5e-4 in the damage that a step lags behind.
#include <doctest/doctest.h>

#include "unit/materials/card_law.hpp"
#include "unit/materials/concrete_rows.hpp"
#include "unit/materials/model_specimen.hpp"

namespace {

using namespace krater;
using namespace krater::test;
using doctest::Approx;
using Specimen = ModelSpecimen<HolmquistJohnsonCook>;

struct Card {
  std::string file, rows, more;
  bool curves;
};
const Card kCards[] = {
    {"concrete_48", "hjc_48/A", "", true},
    {"concrete_48", "hjc_48/B", "model: {holmquist_johnson_cook: {lock_strain: pressure}}", true},
    {"concrete_20", "hjc_20/A", "", false},
    {"concrete_44", "hjc_44/A", "", true},
    {"concrete_150", "hjc_150/A", "", false},
    {"concrete_200", "hjc_200/A", "", false},
    {"concrete_snl_low", "snl_low/A", "", true},
    {"concrete_snl_conventional", "snl_conv/A", "", true},
};
/// Their constants are printed with four digits (0.2399, 7.947e-4), and the rows were made before
/// rounding.
double digits(const Card& card, double fine) {
  return card.file.find("snl") == std::string::npos ? fine : 2e-3;
}
HolmquistJohnsonCook law(const Card& card) {
  return law_of_card<HolmquistJohnsonCook>(card.file, card.more);
}
Specimen confined(const HolmquistJohnsonCook& law, double pressure) {
  Specimen s{law};
  double low = 0, high = 0.2;
  for (int i = 0; i < 60; ++i) {
    const double mu = 0.5 * (low + high);
    (law.line(mu).pressure < pressure ? low : high) = mu;
  }
  if (pressure > 0) s.hydrostatic(low, 2000);
  return s;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("concrete rows: hydrostats, their unloading and what stays, every card") {
    for (const Card& card : kCards) {
      CAPTURE(card.rows);
      const HolmquistJohnsonCook hjc = law(card);
      const double fine = digits(card, 1e-6);
      for (const ConcreteRow& row : concrete_rows("hjc", card.rows, "hydrostat")) {
        CAPTURE(row["mu"]);
        Specimen s{hjc};
        s.hydrostatic(row["mu"], 50);
        CHECK(s.p == Approx(row["p"]).epsilon(fine));
        const auto line = hjc.line(s.mu());
        CHECK(line.modulus == Approx(row["K_unload"]).epsilon(fine));
        CHECK(std::fabs(line.rest() - row["mu_p"]) < fine * row["mu"] + 1e-9);
        // Unloads along K_u to nothing, and comes back to where it was.
        s.hydrostatic(line.rest(), 20);
        CHECK(std::fabs(s.p) < 1e-9 * row["p"]);
        s.hydrostatic(row["mu"], 20);
        CHECK(s.p == Approx(line.pressure).epsilon(1e-12));
      }
    }
  }

  TEST_CASE("concrete rows: strength on the triaxial path, intact and rubble, every card") {
    for (const Card& card : kCards) {
      CAPTURE(card.rows);
      const HolmquistJohnsonCook hjc = law(card);
      for (const ConcreteRow& row : concrete_rows("hjc", card.rows, "triaxial_surface")) {
        CAPTURE(row["sigma3"]);
        CHECK(hjc.f * hjc.strength(row["D"], row["p"] / hjc.f, 1.0) ==
              Approx(row["q"]).epsilon(digits(card, 1e-6)));
      }
    }
    const HolmquistJohnsonCook hjc = law(kCards[0]);
    for (const ConcreteRow& row : concrete_rows("hjc", "hjc_48/A", "rate_factor"))
      CHECK(hjc.f * hjc.strength(0.0, 1.0, std::max(1.0, row["rate"])) ==
            Approx(row["q"]).epsilon(1e-6));
    // The largest strength is applied after the rate: that does not lift it.
    CHECK(hjc.strength(0.0, 20.0, 1000.0) == hjc.S_max);
  }

  TEST_CASE("concrete rows: triaxial peaks with the damage of crushing, every card") {
    for (const Card& card : kCards) {
      CAPTURE(card.rows);
      const HolmquistJohnsonCook hjc = law(card);
      for (const ConcreteRow& row : concrete_rows("hjc", card.rows, "triaxial_peak")) {
        CAPTURE(row["sigma3"]);
        Specimen s = confined(hjc, row["sigma3"]);
        double most = 0, damage = 0;
        // Coarse to nine tenths of the way, then fine.
        const double way = row["eps1"] - s.eps[0];
        for (int i = 0; i < 1000; ++i) s.triaxial(0.00095 * way, row["sigma3"]);
        for (int i = 0; i < 4000 && s.q() > most; ++i) {
          most = s.q(), damage = s.state[0];
          s.triaxial(5e-7, row["sigma3"]);
        }
        CHECK(most == Approx(row["q"]).epsilon(digits(card, 3e-4)));
        CHECK(damage == Approx(row["D"]).epsilon(5e-3));
      }
    }
  }

  TEST_CASE("concrete rows: unconfined compression and uniaxial strain") {
    for (const Card& card : kCards) {
      if (!card.curves) continue;
      CAPTURE(card.rows);
      const HolmquistJohnsonCook hjc = law(card);
      Specimen s{hjc};
      for (const ConcreteRow& row : concrete_rows("hjc", card.rows, "unconfined")) {
        CAPTURE(row["eps1"]);
        if (row["eps1"] > 0.0051) break;
        while (s.eps[0] < row["eps1"] - 1e-6) s.triaxial(2e-6, 0);
        CHECK(s.q() == Approx(row["q"]).epsilon(digits(card, 5e-4)));
        CHECK(s.state[0] == Approx(row["D"]).epsilon(5e-3));
      }
      Specimen u{hjc};
      for (const ConcreteRow& row : concrete_rows("hjc", card.rows, "uniaxial_strain")) {
        if (!row.has("p")) continue;
        CAPTURE(row["mu"]);
        const double way = std::log1p(row["mu"]) - u.eps[0];
        u.strain({way, 0, 0}, static_cast<int>(way / 2e-6) + 1);
        CHECK(u.p == Approx(row["p"]).epsilon(digits(card, 1e-6)));
        CHECK(u.q() == Approx(row["q"]).epsilon(digits(card, 3e-4)));
        CHECK(u.state[0] == Approx(row["D"]).epsilon(2e-3));
      }
    }
  }

  TEST_CASE("concrete rows: tension peaks are stresses above T, every card") {
    for (const Card& card : kCards) {
      CAPTURE(card.rows);
      const HolmquistJohnsonCook hjc = law(card);
      const ConcreteRow direct = concrete_rows("hjc", card.rows, "direct_tension").at(0),
                        held = concrete_rows("hjc", card.rows, "uniaxial_strain_tension").at(0);
      CHECK(hjc.direct_tension() == Approx(direct["q"]).epsilon(1e-6));
      const auto peak = [&](auto step) {
        Specimen s{hjc};
        double most = 0;
        for (int i = 0; i < 4000; ++i) {
          step(s);
          if (-s.stress(0) < most) break;
          most = -s.stress(0);
        }
        return most;
      };
      const double fine = digits(card, 2e-3);  // a step of 5e-7: E times it is 2e-3 of the peak
      CHECK(peak([](Specimen& s) { s.triaxial(-5e-7, 0); }) ==
            Approx(-direct["sigma1"]).epsilon(fine));
      CHECK(peak([](Specimen& s) {
              s.step({-5e-7, 0, 0});
            }) == Approx(-held["sigma1"]).epsilon(2 * fine));
      Specimen s{hjc};
      s.hydrostatic(-5e-3, 100);
      CHECK(s.p == -hjc.T);
    }
  }
}
