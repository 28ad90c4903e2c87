// SPDX-License-Identifier: GPL-3.0-or-later
// Ceramic cards of Johnson and Holmquist's second law against rows computed apart
// (tests/data/concrete_reference.csv, five digits on paths).
#include <doctest/doctest.h>

#include "unit/materials/card_law.hpp"
#include "unit/materials/concrete_rows.hpp"
#include "unit/materials/model_specimen.hpp"

namespace {

using namespace krater;
using namespace krater::test;
using doctest::Approx;
using Specimen = ModelSpecimen<JohnsonHolmquist2>;

struct Card {
  std::string file, rows;
};
const Card kCards[] = {{"float_glass_jh2", "glass"},
                       {"alumina_995_jh2", "alumina"},
                       {"aluminium_nitride_jh2", "aln"},
                       {"silicon_carbide_jh2", "sic"}};

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("ceramics: strength intact and fractured, fracture strain, every card") {
    for (const Card& card : kCards) {
      CAPTURE(card.rows);
      const auto law = law_of_card<JohnsonHolmquist2>(card.file);
      CHECK(law.problem() == nullptr);
      CHECK(law.sigma_HEL ==
            Approx(concrete_rows("jh2", card.rows, "constants").at(0)["value"]).epsilon(1e-6));
      for (const ConcreteRow& row : concrete_rows("jh2", card.rows, "strength_at_p")) {
        CAPTURE(row["p"]);
        const double p = row["p"] / law.P_HEL;
        CHECK(law.strength(p, 1.0).at(row["D"]) == Approx(row["q"]).epsilon(1e-6));
        CHECK(law.fracture_strain(p) == Approx(row["value"]).epsilon(1e-6));
      }
      const auto slow = law.strength(1.0, 1.0), fast = law.strength(1.0, 1 + law.C * std::log(1e4));
      CHECK(fast.intact / slow.intact == Approx(1 + law.C * std::log(1e4)).epsilon(1e-12));
    }
  }

  TEST_CASE("ceramics: uniaxial strain and its release, every card; first order") {
    for (const Card& card : kCards) {
      CAPTURE(card.rows);
      const auto law = law_of_card<JohnsonHolmquist2>(card.file);
      Specimen coarse{law}, fine{law};
      for (const ConcreteRow& row : concrete_rows("jh2", card.rows, "uniaxial_strain")) {
        CAPTURE(row["eps1"]);
        CAPTURE(row.step);
        const double way = row["eps1"] - fine.eps[0];
        coarse.strain({way, 0, 0}, static_cast<int>(std::fabs(way) / 1e-5 + 0.5));
        fine.strain({way, 0, 0}, static_cast<int>(std::fabs(way) / 5e-6 + 0.5));
        const auto found = [](double a, double b) { return 2 * b - a; };  // first order
        // Five digits in the rows; extrapolation leaves the second order of 1e-5/1e-3.
        CHECK(found(coarse.p, fine.p) == Approx(row["p"]).epsilon(3e-4));
        CHECK(found(coarse.q(), fine.q()) == Approx(row["q"]).epsilon(1e-3));
        CHECK(std::fabs(found(coarse.state[0], fine.state[0]) - row["D"]) < 1e-3);
        CHECK(std::fabs(found(coarse.state[1], fine.state[1]) - row["dP"]) < 1e-3 * row["p"]);
        CHECK(std::fabs(found(coarse.plastic, fine.plastic) - row["eps_p"]) <
              2e-3 * row["eps_p"] + 1e-9);
      }
    }
  }

  TEST_CASE("ceramics: tension ends at T, rubble bears none; bulking only under compression") {
    const auto law = law_of_card<JohnsonHolmquist2>("aluminium_nitride_jh2");
    Specimen s{law};
    s.hydrostatic(-0.01, 100);
    CHECK(s.p == -law.T);
    CHECK(s.state[0] == 0);
    Specimen drawn{law};
    for (int i = 0; i < 2000; ++i) {
      const double cut = law.T * (1 - drawn.state[0]);
      drawn.step({-5e-6, 0, 0});
      CHECK(drawn.p >= -cut * (1 + 1e-12));
    }
    CHECK(drawn.state[0] == 1);
    CHECK(drawn.failed);
    CHECK(drawn.q() == 0);
    CHECK(drawn.state[1] == 0);
    const auto none = law_of_card<JohnsonHolmquist2>("aluminium_nitride_jh2",
                                                     "model: {johnson_holmquist_2: {beta: 0}}");
    Specimen still{none};
    still.strain({0.08, 0, 0}, 4000);
    CHECK(still.state[0] > 0.5);
    CHECK(still.state[1] == 0);
  }

  TEST_CASE("ceramics: what is wrong between parameters is said") {
    auto law = law_of_card<JohnsonHolmquist2>("float_glass_jh2");
    law.K2 *= 1e3;  // GPa written as if they were MPa of an MPa card, and the other way round
    law.prepare({2530, 30.4e9, 293});
    CHECK(std::string{law.problem()}.find("falls with compression") != std::string::npos);
    law.K2 /= 1e3;
    law.P_HEL = law.HEL;
    CHECK(std::string{law.problem()}.find("HEL must exceed") != std::string::npos);
  }
}
