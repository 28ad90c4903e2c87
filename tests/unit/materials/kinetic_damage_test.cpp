// SPDX-License-Identifier: GPL-3.0-or-later
// Concrete whose damage takes time: slow strengths, damage at constant overload, strength at the
// rates of rows computed apart (tests/data/concrete_reference.csv, four digits).
#include <doctest/doctest.h>

#include "unit/materials/card_law.hpp"
#include "unit/materials/concrete_rows.hpp"
#include "unit/materials/model_specimen.hpp"

namespace {

using namespace krater;
using namespace krater::test;
using doctest::Approx;
using Specimen = ModelSpecimen<KineticDamage>;
constexpr double kF = 39.3e6, kFt = 3.476e6, kE = 29.67e9, kNu = 0.2;

/// Elastic far beyond any stress here, as the rows were made.
KineticDamage law(const std::string& more = "") {
  return law_of<KineticDamage>(
      "density: 2243, youngs_modulus: 29.67 GPa, poisson_ratio: 0.2, model: {kinetic_damage: "
      "{compressive_strength: 39.3 MPa, tensile_strength: 3.476 MPa, crush_pressure: 400 MPa, "
      "crush_compression: 0.0242669, lock_pressure: 0.8 GPa, lock_compression: 0.1269, K1: 85 GPa, "
      "K2: -171 GPa, K3: 208 GPa" +
      more + "}}");
}
/// Largest q at an axial rate.
double peak(int sign, double rate) {
  Specimen s{law()};
  s.rate = rate * 2 / 3 * (1 + kNu);
  const double step = (sign > 0 ? kF : kFt) / kE / 4000;
  double most = 0;
  for (int i = 0; i < 20000 && s.q() >= 0.9 * most; ++i) {
    s.triaxial(sign * step, 0);
    most = std::max(most, s.q());
  }
  return most;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("kinetic_damage: slow strengths are f and f_t, the upper surface c_u times them") {
    const KineticDamage k = law();
    CHECK(k.problem() == nullptr);
    CHECK(k.intact_strength(0.0) == kF);
    CHECK(k.intact_strength(kFt) == Approx(kFt).epsilon(1e-12));
    CHECK(k.intact_strength(-kF) == Approx(4 * kF));
    CHECK(k.intact_strength(-10 * kF) == Approx(7 * kF));
    CHECK(k.intact_strength(2 * kFt) == 0);
    // Direct tension q = 3|p|, theta = 0; unconfined q = 3p, theta = 60 degrees.
    CHECK(k.strength(0.0, -kFt, 2.0 / 3.0) == Approx(3 * kFt).epsilon(1e-12));
    CHECK(k.strength(0.0, kF, 1.0 / 3.0) == Approx(3 * kF).epsilon(1e-12));
    CHECK(k.strength(1.0, kF, 1.0 / 3.0) == Approx(2.5 * kF / (1 + 2.5 / 3)).epsilon(1e-12));
    CHECK(k.strength(1.0, -kFt, 2.0 / 3.0) == 0);
    CHECK(k.strength(0.3, 50 * kF, 1.0 / 3.0) == Approx(7 * kF));
  }

  TEST_CASE("kinetic_damage: at constant overload 1 - phi falls exponentially") {
    const KineticDamage k = law();
    const double q = 1.5 * kF;  // at T1 = 0: Omega_s = 1/2
    double phi = 0;
    for (int i = 0; i < 40; ++i) {
      CoupledStep<double> step{{-q / 3 * 2, q / 3, q / 3, 0, 0, 0}, q, 0, 0, 0, 0, 0, 1e-6, 0};
      step.rho = k.rho0 * (1 + q / 3 / k.K_el);
      step.v = 1 / step.rho;
      const auto u = k.at(std::array{phi, 0.0}).update(step);
      if (u.q < q) break;
      phi = u.state[0];
      CHECK(phi == Approx(1 - std::exp(-0.25 * (i + 1) * 0.1)).epsilon(1e-6));
    }
    CHECK(phi > 0.3);
  }

  TEST_CASE("kinetic_damage: strength grows with the rate of loading and saturates") {
    for (const ConcreteRow& row : concrete_rows("kinetic", "kin_39.30MPa", "unconfined"))
      CHECK(peak(1, row["rate"]) / kF == Approx(row["value"]).epsilon(3e-4));
    for (const ConcreteRow& row : concrete_rows("kinetic", "kin_39.30MPa", "direct_tension")) {
      if (row["rate"] > 10)
        CHECK(peak(-1, row["rate"]) / kFt == Approx(row["value"]).epsilon(3e-4));
      if (row["rate"] > 10) continue;
      // The slow rows do not know the tension cut, which is lower there, q = 3 c_u f_t (1 - phi):
      // x = 9 exp(-(x - 1)^3 t0/(3 tau_t)), t0 = f_t/(E rate).
      double low = 1, high = 3;
      for (int i = 0; i < 60; ++i) {
        const double x = 0.5 * (low + high), t0 = kFt / kE / row["rate"];
        (x < 9 * std::exp(-std::pow(x - 1, 3) * t0 / 3 / 3e-6) ? low : high) = x;
      }
      CHECK(low < row["value"]);
      CHECK(peak(-1, row["rate"]) / kFt == Approx(low).epsilon(1e-3));
    }
    CHECK(peak(-1, 1e5) / kFt == Approx(3.0).epsilon(1e-2));
  }

  TEST_CASE("kinetic_damage: what is wrong between parameters is said") {
    CHECK_THROWS_WITH_AS(law(", overload_max: 0.5"), doctest::Contains("encloses"), InputError);
    CHECK_THROWS_WITH_AS(law(", intact_slope: 1"), doctest::Contains("damaged_slope"), InputError);
    CHECK_THROWS_WITH_AS(law(", intact_slope: 20"), doctest::Contains("never closes"), InputError);
  }
}
