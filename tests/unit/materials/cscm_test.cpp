// SPDX-License-Identifier: GPL-3.0-or-later
// The continuous surface cap model, generated from its strength, against rows computed apart
// (tests/data/concrete_reference.csv) and the design's tables: constants and surfaces 1e-6, paths
// of first order at 1e-5 strain per step 1e-3. Damage and rate against closed forms.
#include <doctest/doctest.h>

#include <tuple>

#include "unit/materials/card_law.hpp"
#include "unit/materials/concrete_rows.hpp"
#include "unit/materials/model_specimen.hpp"

namespace {

using namespace krater;
using namespace krater::test;
using doctest::Approx;
using Specimen = ModelSpecimen<Cscm>;

Cscm law(const std::string& f, const std::string& more) {
  return law_of<Cscm>("density: 2243, model: {cscm: {compressive_strength: " + f + " MPa" + more +
                      "}}");
}
struct Card {
  std::string set, f;
  std::string rows() const { return set + "_" + f + "MPa"; }
  /// As the rows were made.
  Cscm bare() const {
    return law(f, ", set: " + set + ", cap_start: published, softening: none, rate_factor: none");
  }
};
const Card kCards[] = {{"fhwa", "22.75"}, {"fhwa", "30.00"}, {"fhwa", "39.30"}, {"fhwa", "48.00"},
                       {"rev3", "22.75"}, {"rev3", "30.00"}, {"rev3", "39.30"}, {"rev3", "48.00"}};
Cscm softening() { return law("30", ", rate_factor: none"); }

void confine(Specimen& s, double pressure) {
  for (int i = 1; pressure > 0 && i <= 50; ++i) s.hydrostatic_to_pressure(pressure * i / 50);
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("cscm: constants of both sets, and the shear surface") {
    for (const Card& card : kCards) {
      CAPTURE(card.rows());
      const Cscm c = card.bare();
      const CscmSurface& shear = c.constants.shear;
      const std::map<std::string, double> own{{"K", c.K},
                                              {"G", c.G},
                                              {"alpha", shear.alpha},
                                              {"lambda_", shear.lambda},
                                              {"theta", shear.theta},
                                              {"beta_per_Pa", shear.beta},
                                              {"X0", c.constants.cap.X0},
                                              {"kappa0", c.first_corner},
                                              {"tension", c.f_t},
                                              {"triaxial_tension", -shear.apex / 3},
                                              {"shear", shear.at(0.0).strength / std::sqrt(3.0)}};
      for (const ConcreteRow& row : concrete_rows("cscm", card.rows(), "constants")) {
        CAPTURE(row.step);
        CHECK(own.at(row.step) == Approx(row["value"]).epsilon(1e-6));
      }
      for (const ConcreteRow& row : concrete_rows("cscm", card.rows(), "triaxial_surface"))
        CHECK(std::sqrt(3.0) * shear.at(3 * row["p"]).strength == Approx(row["q"]).epsilon(1e-6));
    }
    // In psi, as decks have them; with MPa eta of compression is 3.172e-4.
    const CscmRates r = law("30", "").constants.rates;
    CHECK(r.base_c == Approx(1.003430e-4).epsilon(1e-6));
    CHECK(r.base_t == Approx(6.176035e-5).epsilon(1e-6));
    CHECK(r.overstress == Approx(21.45399e6).epsilon(1e-6));
  }

  TEST_CASE("cscm: which set closes at f depends on the cap; the default does from 20 to 58 MPa") {
    const std::vector<std::tuple<const char*, double, double>> table{
        {"20", 0.84803, 0.69235}, {"22.75", 0.92281, 0.69491}, {"28", 1.00034, 0.85168},
        {"30", 1.01038, 0.90403}, {"35", 1.01212, 0.98147},    {"39.3", 1.00051, 1.00299},
        {"46", 0.97583, 1.00518}, {"48", 0.96848, 1.00511},    {"58", 0.93835, 0.99925}};
    for (const auto& [strength, fhwa, rev3] : table) {
      const std::string f = strength;
      CAPTURE(f);
      const Cscm a = law(f, ", set: fhwa"), b = law(f, ", set: rev3, cap_start: published");
      CHECK(a.unconfined() / a.f == Approx(fhwa).epsilon(1e-5));
      CHECK(b.unconfined() / b.f == Approx(rev3).epsilon(1e-5));
      const Cscm chosen = law(f, "");
      CHECK(chosen.refit() == (chosen.f < 26e6));
      CHECK(std::fabs(chosen.unconfined() / chosen.f - 1) < 0.07);
    }
    // The refit closes where its cap is put off: .98807 for the low strength of the SNL shots.
    const Cscm low = law("22.75", "");
    CHECK(low.unconfined() == Approx(0.988067 * low.f).epsilon(1e-5));
    CHECK(low.first_corner >= low.f * (1 - 1e-12));
    CHECK(law("39.3", ", set: rev3").constants.cap.X0 ==
          law("39.3", ", set: rev3, cap_start: published").constants.cap.X0);
  }

  TEST_CASE("cscm: hydrostat, its unloading, and the cap that stays") {
    for (const Card& card : kCards) {
      CAPTURE(card.rows());
      for (const ConcreteRow& row : concrete_rows("cscm", card.rows(), "hydrostat")) {
        CAPTURE(row["p"]);
        Specimen s{card.bare(), 5e-3};
        s.hydrostatic(std::expm1(row["eps_v"]), 50);
        // K times the seventh digit of the rows' strain.
        CHECK(s.p == Approx(row["p"]).epsilon(3e-6));
        CHECK(s.state[2] == Approx(row["kappa"]).epsilon(1e-5));
        const double p = s.p, back = 0.5 * p / s.law.K;
        s.strain({-back / 3, -back / 3, -back / 3}, 10);
        CHECK(s.p == Approx(0.5 * p).epsilon(1e-12));
        s.strain({back / 3, back / 3, back / 3}, 10);
        CHECK(s.p == Approx(p).epsilon(1e-12));
      }
    }
  }

  TEST_CASE("cscm: uniaxial strain") {
    for (const Card& card : {kCards[0], kCards[1], kCards[2], kCards[4], kCards[6]}) {
      CAPTURE(card.rows());
      Specimen s{card.bare(), 5e-3};
      for (const ConcreteRow& row : concrete_rows("cscm", card.rows(), "uniaxial_strain")) {
        if (!row.has("p")) continue;
        CAPTURE(row["eps1"]);
        const double way = row["eps1"] - s.eps[0];
        s.strain({way, 0, 0}, static_cast<int>(way / 1e-5 + 0.5));
        CHECK(s.p == Approx(row["p"]).epsilon(1e-3));
        CHECK(s.q() == Approx(row["q"]).epsilon(1e-3));
        CHECK(s.state[2] == Approx(row["kappa"]).epsilon(1e-3));
        CHECK(std::fabs(s.plastic - row["eps_p"]) < 1e-2 * row["eps_p"] + 1e-9);
      }
    }
  }

  TEST_CASE("cscm: strength in triaxial compression, with the cap that the test moves") {
    for (const Card& card : {kCards[1], kCards[6]}) {
      CAPTURE(card.rows());
      for (const ConcreteRow& row : concrete_rows("cscm", card.rows(), "triaxial_strength")) {
        CAPTURE(row["sigma3"]);
        Specimen s{card.bare(), 5e-3};
        confine(s, row["sigma3"]);
        for (int i = 0; i < 1000; ++i) s.triaxial(row["sigma3"] > 0 ? 2e-4 : 2e-5, row["sigma3"]);
        CHECK(s.q() == Approx(row["q"]).epsilon(1e-4));
        CHECK(s.state[2] == Approx(row["kappa"]).epsilon(1e-4));
      }
    }
    const Card& card = kCards[2];
    Specimen s{card.bare(), 5e-3};
    confine(s, 10e6);
    for (const ConcreteRow& row : concrete_rows("cscm", card.rows(), "triaxial")) {
      CAPTURE(row["eps1"]);
      while (s.eps[0] < row["eps1"] - 1e-12)
        s.triaxial(std::min(4e-6, row["eps1"] - s.eps[0]), 10e6);
      CHECK(s.q() == Approx(row["q"]).epsilon(2e-3));
      CHECK(s.volume_strain() == Approx(row["eps_v"]).epsilon(5e-3));
    }
    Specimen u{card.bare(), 5e-3};
    for (const ConcreteRow& row : concrete_rows("cscm", card.rows(), "unconfined")) {
      while (u.eps[0] < row["eps1"] - 1e-12) u.triaxial(1e-5, 0);
      CHECK(u.q() == Approx(row["q"]).epsilon(1e-3));
      CHECK(u.volume_strain() == Approx(row["eps_v"]).epsilon(2e-3));
    }
  }

  TEST_CASE("cscm: a bound of the strength") {
    Specimen s{law("39.3", ", strength_max: 2, softening: none, rate_factor: none"), 5e-3};
    s.strain({0.3, 0, 0}, 3000);
    CHECK(s.q() <= 2 * 39.3e6 * (1 + 1e-12));
    s.strain({0, -1e-3, -1e-3}, 100);
    CHECK(s.q() == Approx(2 * 39.3e6).epsilon(1e-9));
    // A point without a length does not soften, and does not divide by it.
    Specimen point{kCards[1].bare()};
    for (int i = 0; i < 2000; ++i) point.triaxial(2e-6, 0);
    CHECK(point.q() == Approx(point.law.unconfined()).epsilon(1e-3));
  }

  TEST_CASE("cscm: slopes of damage by the energies per area") {
    Cscm c = softening();
    // The design's numbers, B5.5.
    c.E = 26.36e9, c.root_E = std::sqrt(c.E), c.f_t = 2.9e6, c.fracture = 70;
    c.brittle = c.f_t / c.root_E * (1 + c.D) * std::log1p(c.D) / c.D;
    CHECK(c.brittle_growth(1.0, 0.025) / c.root_E == Approx(7.0921e-3).epsilon(1e-4));
    const double r = 30e6 / std::sqrt(2 * c.E), L = 0.025;
    CHECK(r == Approx(130.6573).epsilon(1e-6));
    const double work = 1e5, z = std::sqrt(r * r + 0.5 * work) - r;
    CHECK(c.ductile_growth(work, r * r, 7000 + L * r * r, L) / z ==
          Approx(1.833277e-2).epsilon(1e-6));
  }

  TEST_CASE("cscm: direct tension gives f_t and dissipates G_f at any width; triaxial as well") {
    const Cscm c = softening();
    CHECK(c.fracture == Approx(56.29).epsilon(1e-3));
    double triaxial[3], *next = triaxial;
    for (const double length : {2.5e-3, 5e-3, 10e-3}) {
      CAPTURE(length);
      Specimen s{c, length};
      const double step = 4e-8 / length;
      double most = 0;
      for (int i = 0; i < 20000 && !s.failed; ++i) {
        s.triaxial(i < 500 ? -2e-7 : -step, 0);
        most = std::max(most, s.q());
      }
      CHECK(s.failed);
      CHECK(most == Approx(c.f_t).epsilon(1e-3));
      CHECK(s.energy * c.rho0 * length == Approx(c.fracture).epsilon(0.02));
      CHECK((s.plastic_work + s.crush) * c.rho0 * length == Approx(c.fracture).epsilon(0.02));
      Specimen t{c, length};
      for (int i = 0; i < 40000 && !t.failed; ++i) t.step({-step / 3, -step / 3, -step / 3});
      CHECK(t.failed);
      *next++ = t.energy * c.rho0 * length;
    }
    // Three cracks at once cost more than one; how much more does not depend on the width.
    CHECK(triaxial[0] == Approx(triaxial[1]).epsilon(0.05));
    CHECK(triaxial[2] == Approx(triaxial[1]).epsilon(0.05));
  }

  TEST_CASE("cscm: unconfined compression dissipates G_fc at any width") {
    const Cscm c = softening();
    for (const double length : {10e-3, 20e-3, 40e-3}) {
      CAPTURE(length);
      Specimen s{c, length};
      double work = 0, most = 0;
      for (int i = 0; i < 20000 && s.state[1] < 0.998; ++i) {
        const double before = s.stress(0);
        s.triaxial(2e-7 / length, 0);
        work += 0.5 * (before + s.stress(0)) * 2e-7 / length;
        most = std::max(most, s.q());
      }
      CHECK(s.state[1] >= 0.998);
      CHECK(most == Approx(c.unconfined()).epsilon(1e-3));
      CHECK(work * length == Approx(c.crushing).epsilon(0.05));
    }
  }

  TEST_CASE("cscm: confined concrete bears on; closed cracks carry pressure, without energy") {
    const Cscm c = softening();
    Specimen s{c, 5e-3}, bare{kCards[1].bare(), 5e-3};
    for (Specimen* x : {&s, &bare}) {
      confine(*x, 30e6);
      for (int i = 0; i < 1000; ++i) x->triaxial(1e-4, 30e6);
    }
    CHECK(s.q() == Approx(bare.q()).epsilon(1e-3));

    // A little confinement: it softens, to (q/J1)^(3/2) only.
    Specimen held{c, 5e-3};
    confine(held, 1e6);
    for (int i = 0; i < 3000; ++i) held.triaxial(2e-5, 1e6);
    CHECK(held.state[1] == Approx(std::pow(held.q() / (3 * held.p), 1.5)).epsilon(1e-2));
    CHECK(held.q() > 10e6);

    Specimen cracked{c, 5e-3};
    for (int i = 0; i < 20000 && !cracked.failed; ++i) cracked.triaxial(-2e-6, 0);
    CHECK(cracked.failed);
    CHECK(cracked.q() < 0.01 * c.f_t);
    // Closed, then pressed: K again, from the strain at which the gap is closed.
    double before = 0;
    for (int i = 0; i < 20000 && cracked.p < 20e6; ++i) {
      before = cracked.p;
      cracked.step({1e-6, 1e-6, 1e-6});
    }
    CHECK(cracked.p - before == Approx(3e-6 * c.K).epsilon(1e-6));
    CHECK(cracked.state[0] >= Cscm::kMost);
    CHECK(cracked.state[1] == 0);
  }

  TEST_CASE("cscm: an open gap closes without force") {
    Specimen s{softening(), 5e-3};
    s.hydrostatic(-0.01, 2000);
    CHECK(s.state[4] == Approx(-std::log1p(-0.01)).epsilon(0.01));
    s.hydrostatic(-0.005, 100);
    CHECK(s.p == 0);
    s.hydrostatic(1e-3, 100);
    // All plastic volume was the gap's.
    CHECK(s.p == Approx(s.law.K * std::log1p(1e-3)).epsilon(1e-9));
  }

  TEST_CASE("cscm: at a constant rate flow lags by eta, in compression and in tension") {
    for (const bool pressed : {true, false}) {
      for (const double rate : {1e-2, 1.0, 1e5}) {
        CAPTURE(pressed);
        CAPTURE(rate);
        const Cscm c = law("39.3", ", set: rev3, softening: none");
        Cscm slow = c;
        slow.viscous = 0;
        Specimen s{c, 5e-3, rate};
        const double step = pressed ? 2e-6 : -5e-7;
        for (int i = 0; i < 4000; ++i) s.triaxial(step, 0);
        // A step more, and what it would end in without a rate.
        Specimen end{slow, 5e-3, rate};
        end.s = s.s, end.eps = s.eps, end.p = s.p, end.v = s.v, end.state = s.state;
        const Specimen last = s;
        s.triaxial(step, 0);
        const double axial = s.eps[0] - last.eps[0], side = s.eps[1] - last.eps[1];
        end.step({axial, side, side});
        const double flowed = s.plastic - last.plastic, volume = s.state[3] - last.state[3];
        const double equivalent = 2.0 / 3.0 * std::fabs(axial - side), dt = equivalent / rate;
        const CscmRates& r = c.constants.rates;
        const double most = r.overstress / (c.E * rate);
        const double eta_t = std::min(most, r.base_t / std::pow(rate, r.power_t)),
                     eta_c = std::min(most, r.base_c / std::pow(rate, r.power_c));
        const double trans = std::min(
            1.0, 3 * (last.p + c.K * (axial + 2 * side)) / (last.q() + 3 * c.G * equivalent));
        const double eta = pressed ? eta_t + std::pow(trans, 5) * (eta_c - eta_t) : eta_t;
        CHECK((eta == most) == (rate == 1e5));
        CHECK(s.q() - end.q() == Approx(3 * c.G * eta * flowed / dt).epsilon(1e-4));
        CHECK(s.p - end.p == Approx(c.K * eta * volume / dt).epsilon(1e-4));
        // Steady: all of the axial strain flows, so along the axis the stress is E rate eta above.
        if (rate > 1e4) continue;
        const double sign = pressed ? 1.0 : -1.0;
        const double above = (s.q() - end.q()) / (3 * c.G) + sign * (s.p - end.p) / (3 * c.K);
        CHECK(above == Approx(eta * std::fabs(axial) / dt).epsilon(1e-3));
      }
    }
  }

  TEST_CASE("cscm: what is wrong is said; the widest cell") {
    CHECK_THROWS_WITH_AS(law("15", ""), doctest::Contains("20 to 58 MPa"), InputError);
    CHECK_THROWS_WITH_AS(law("60", ""), doctest::Contains("karagozian_case"), InputError);
    CHECK_THROWS_WITH_AS(law_of<Cscm>("density: 2243, shear_modulus: 10 GPa, model: {cscm: "
                                      "{compressive_strength: 39 MPa}}"),
                         doctest::Contains("has its own shear modulus"), InputError);
    const Cscm c = softening();
    CHECK(c.largest_length() ==
          Approx(2 * c.E * std::min(c.fracture / (c.f_t * c.f_t), c.crushing / (c.f * c.f))));
    CHECK(kCards[1].bare().largest_length() == 0);
  }
}
