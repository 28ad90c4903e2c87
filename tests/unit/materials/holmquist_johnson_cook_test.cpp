// SPDX-License-Identifier: GPL-3.0-or-later
// Concrete of 48 MPa against values that were computed apart, by quadrature along the paths and
// closed forms, not by a step-by-step update: pressure on its three branches, strength, damage,
// tension, alone and through the stages.
#include "krater/materials/model/holmquist_johnson_cook.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "contract/material_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;
using doctest::Approx;

constexpr MaterialConstants kConcrete{2440.0, 14.86e9, 293.0};
constexpr double kF = 48e6, kT = 4e6;

HolmquistJohnsonCook law(double reading = 0.0) {
  const double values[parameter_count<HolmquistJohnsonCook>] = {
      // the rest: options, off
      kF, 0.79, 1.6,  0.61,  0.007, 1.0,     7.0,  0.04,   1.0,  0.01,
      kT, 16e6, 1e-3, 0.8e9, 0.1,   reading, 85e9, -171e9, 208e9};
  return make_law<HolmquistJohnsonCook>(values, kConcrete);
}

Recipe concrete() {
  Recipe recipe{.strength = "", .eos = "", .viscosity = false, .model = "holmquist_johnson_cook"};
  recipe.constants = kConcrete;  // its typical parameters are those of 48 MPa
  recipe.rate = Rate::jaumann;   // without spin s + 2G dev(d eps), as the values were computed
  return recipe;
}

/// One point under prescribed stretches, slowly: the rate factor is 1.
struct Specimen {
  Body body{*stage_factory_isa_portable(), concrete(), 1, 1};
  double lateral = 0;  ///< stretch of the last step, where the lateral stress is prescribed

  double value(const char* field, int k = 0) { return body.state(field, 0, k); }
  double mu() { return value("density") / kConcrete.density - 1; }
  double p() { return value("pressure"); }
  double q() { return -1.5 * value("deviatoric_stress"); }  ///< of states about x, compression > 0
  double axial() { return p() - value("deviatoric_stress"); }

  void step(double x, double y) {
    body.local("step_gradient", 0, 0) = x;
    for (const int k : {4, 8}) body.local("step_gradient", 0, k) = y;
    body.step(1.0);
  }
  void hydrostatic(double to, int steps) {
    const double from = mu();
    for (int i = 1; i <= steps; ++i) {
      const double stretch = std::cbrt((1 + mu()) / (1 + from + (to - from) * i / steps)) - 1;
      step(stretch, stretch);
    }
  }
  void uniaxial(double to, int steps) {
    const double from = mu();
    for (int i = 1; i <= steps; ++i) step((1 + mu()) / (1 + from + (to - from) * i / steps) - 1, 0);
  }
  /// One step of axial shortening at a lateral pressure.
  void triaxial(double shortening, double pressure) {
    const std::vector<double> kept = body.storage();
    const auto residual = [&](double y) {
      body.storage() = kept;
      step(-shortening, y);
      return p() - value("deviatoric_stress", 1) - pressure;
    };
    double x0 = lateral, r0 = residual(x0), x1 = x0 + 1e-7;
    for (int i = 0; i < 50; ++i) {
      const double r1 = residual(x1);
      if (std::fabs(r1) < 0.01 || r1 == r0) break;
      const double next = x1 - r1 * (x1 - x0) / (r1 - r0);
      x0 = x1, r0 = r1, x1 = next;
    }
    lateral = x1;
  }
};

struct Compression {
  double mu, p, K, lasting;
};
// The last two lie in compact material.
constexpr Compression kGrain[] = {
    {0.0005, 8e6, 16e9, 0},
    {0.001, 16e6, 16e9, 0},
    {0.01, 80.4064e6, 21.0336e9, 0.0061772},
    {0.05, 366.6572e6, 43.4053e9, 0.0415527},
    {0.1, 724.4707e6, 71.3698e9, 0.0898491},
    {0.12, 1490.176e6, 77.2727e9, 0.1002014},  // counts up to the end of crushing
    {0.2, 6470.323e6, 77.2727e9, 0.1002014},
};
constexpr Compression kPressure[] = {{0.01, 87.2727e6, 21.6376e9, 0},
                                     {0.08, 641.6162e6, 65.4860e9, 0},
                                     {0.11, 1536.812e6, 78.0141e9, 0},
                                     {0.15, 4225.349e6, 78.0141e9, 0}};

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("concrete: loading curve and unloading lines on all three branches, both readings") {
    const HolmquistJohnsonCook a = law();
    CHECK(a.problem() == nullptr);
    CHECK(a.mu_pl == Approx(0.1105543).epsilon(1e-6));
    CHECK(a.crush_slope == Approx(7.156269e9).epsilon(1e-6));
    for (const Compression& c : kGrain) {
      CAPTURE(c.mu);
      CHECK(a.line(c.mu).pressure == Approx(c.p).epsilon(2e-6));
      CHECK(a.line(c.mu).modulus == Approx(c.K).epsilon(2e-6));
      CHECK(std::fabs(a.lasting(c.mu) - c.lasting) < 1e-7);
    }
    const HolmquistJohnsonCook b = law(1.0);
    CHECK(b.mu_L == Approx(0.0895460).epsilon(1e-6));
    for (const Compression& c : kPressure) {
      CHECK(b.line(c.mu).pressure == Approx(c.p).epsilon(2e-6));
      CHECK(b.line(c.mu).modulus == Approx(c.K).epsilon(3e-6));
    }
    // A card whose K1 lies below g': the line is not shallower than the loading curve.
    HolmquistJohnsonCook soft = law();
    soft.K1 = 17e9, soft.K2 = 38e9, soft.K3 = 29.8e9;
    soft.prepare(kConcrete);
    CHECK(soft.K_closed == Approx(soft.grain_slope(soft.locking_strain()) / 1.1));
  }

  TEST_CASE("concrete: strength at pressures, rate, cap and tension") {
    const HolmquistJohnsonCook c = law();
    // sigma3, surface at D = 0 and at D = 1 on the path q = 3 (p - sigma3).
    const double surface[][3] = {{0, 99.0448e6, 28.7316e6},
                                 {50e6, 160.6853e6, 110.1712e6},
                                 {200e6, 267.6075e6, 222.2933e6},
                                 {400e6, 336e6, 323.8594e6}};
    for (const auto& row : surface) {
      const auto& [lateral, intact, rubble] = row;
      CAPTURE(row[0]);
      for (const double D : {0.0, 1.0}) {
        const double q = D == 0.0 ? intact : rubble, p = lateral + q / 3;
        CHECK(kF * c.strength(D, p / kF, 1.0) == Approx(q).epsilon(1e-6));
      }
    }
    CHECK(c.strength(0.2, 2.0, 1e3) / c.strength(0.2, 2.0, 1.0) ==
          Approx(1 + 0.007 * std::log(1e3)).epsilon(1e-13));
    CHECK(c.strength(0.0, 9.3, 1e3) == 7.0);  // the rate does not lift the cap
    for (const double D : {0.0, 0.4}) {
      CHECK(c.strength(D, -1e-9, 1.0) == Approx(0.79 * (1 - D)).epsilon(1e-6));
      CHECK(std::fabs(c.strength(D, -kT * (1 - D) / kF, 1.0)) < 1e-14);
      CHECK(c.strength(D, -1.0, 1.0) == 0);
    }
    CHECK(c.fracture_strain(1.0) == Approx(0.04 * (1 + kT / kF)).epsilon(1e-14));
    CHECK(c.fracture_strain(-1.0) == 0.01);
  }

  TEST_CASE("concrete through the stages: hydrostatic loading, unloading, reloading; its work") {
    for (const Compression& c : kGrain) {
      CAPTURE(c.mu);
      Specimen s;
      s.hydrostatic(c.mu, 400);
      CHECK(s.p() == Approx(c.p).epsilon(2e-6));
      CHECK(std::fabs(s.q()) < 1e-6 * kF);
      const double e = s.value("internal_energy"), back = 0.5 * c.p / c.K;
      s.hydrostatic(c.mu - back, 50);
      CHECK(s.p() == Approx(0.5 * c.p).epsilon(1e-5));
      s.hydrostatic(c.mu, 50);
      CHECK(s.p() == Approx(c.p).epsilon(2e-6));
      CHECK(s.value("internal_energy") == Approx(e).epsilon(1e-9));  // up and down one line
      CHECK(s.value("compaction") == Approx(c.mu).epsilon(1e-10));
    }
  }

  TEST_CASE(
      "concrete: damage by crushing alone is the integral of d mu_p over the fracture strain") {
    const HolmquistJohnsonCook c = law();
    Specimen s;
    s.hydrostatic(0.02, 2000);
    double D = 0;
    const int n = 20000;
    for (int i = 0; i < n; ++i) {
      const double from = 0.02 * i / n, to = 0.02 * (i + 1) / n;
      const double p = c.line(0.5 * (from + to)).pressure / kF;
      D += (c.lasting(to) - c.lasting(from)) / std::max(0.04 * (p + kT / kF), 0.01);
    }
    CHECK(s.value("damage") == Approx(D).epsilon(2e-3));
    CHECK(s.value("damage") > 0.2);
    const double reached = s.value("damage");
    s.hydrostatic(0.015, 20);
    s.hydrostatic(0.02, 20);
    CHECK(s.value("damage") == reached);
    CHECK(s.value("plastic_strain") < 1e-12);
  }

  TEST_CASE("concrete: triaxial compression fails at the strength that crushing has left") {
    // sigma3, peak of q, damage there: quadrature along the path.
    const double peaks[][3] = {
        {0, 95.38146e6, 0.0599716}, {50e6, 151.2507e6, 0.1884722}, {100e6, 190.4822e6, 0.2540571}};
    for (const auto& row : peaks) {
      const auto& [lateral, peak, damage] = row;
      CAPTURE(row[0]);
      Specimen s;
      if (lateral > 0) s.hydrostatic(1e-3 + (lateral - 16e6) / 7.156269e9, 500);
      double most = 0, at = 0;
      for (int i = 0; i < 4000; ++i) {
        s.triaxial(4e-6, lateral);
        if (s.q() <= most) break;
        most = s.q();
        at = s.value("damage");
      }
      CHECK(most == Approx(peak).epsilon(1e-3));
      CHECK(at == Approx(damage).epsilon(5e-3));
    }
  }

  TEST_CASE("concrete: uniaxial strain") {
    // mu, axial stress, q, damage, plastic strain.
    const double rows[][5] = {{0.002, 62.74336e6, 59.38064e6, 0.0308215, 0},
                              {0.005, 115.8287e6, 106.8054e6, 0.1206227, 0.000929214},
                              {0.02, 271.1229e6, 178.7306e6, 0.3774239, 0.009192541}};
    Specimen s;
    for (const auto& row : rows) {
      const auto& [mu, axial, q, damage, plastic] = row;
      CAPTURE(row[0]);
      s.uniaxial(mu, static_cast<int>((mu - s.mu()) / 4e-6));
      CHECK(s.axial() == Approx(axial).epsilon(2e-3));
      CHECK(s.q() == Approx(q).epsilon(2e-3));
      CHECK(s.value("damage") == Approx(damage).epsilon(5e-3));
      CHECK(std::fabs(s.value("plastic_strain") - plastic) < 2e-3 * plastic + 1e-9);
    }
  }

  TEST_CASE("concrete in tension: the cut falls with damage; rubble has friction and no tension") {
    Specimen pulled;
    pulled.hydrostatic(-5e-3, 200);
    CHECK(pulled.p() == Approx(-kT).epsilon(1e-12));
    CHECK(pulled.value("damage") == 0);  // no plastic strain: no softening
    // Uniaxial strain: the peak is 1.87 T.
    Specimen drawn;
    double most = 0;
    for (int i = 0; i < 3000; ++i) {
      drawn.step(1e-7, 0);
      most = std::max(most, -drawn.axial());
      const double D = drawn.value("damage");
      CHECK(drawn.p() >= -kT * (1 - D) - 0.02 * kT);
    }
    CHECK(most == Approx(7.486752e6).epsilon(1e-3));
    Specimen rubble;
    rubble.body.state("damage", 0) = 1;
    rubble.uniaxial(0.01, 2000);
    CHECK(rubble.q() == Approx(1.6 * kF * std::pow(rubble.p() / kF, 0.61)).epsilon(1e-12));
    CHECK(rubble.value("failed") == 1);
    CHECK(rubble.body.ledger.failures == 1);
    rubble.uniaxial(-0.01, 2000);
    CHECK(rubble.p() == 0);
    CHECK(rubble.q() == 0);
  }

  TEST_CASE("concrete: what is wrong between parameters is said") {
    const auto problem = [](auto change) {
      HolmquistJohnsonCook c = law();
      change(c);
      c.prepare(kConcrete);
      return std::string{c.problem() ? c.problem() : ""};
    };
    CHECK(problem([](auto& c) { c.p_lock = 10e6; }).find("lock_pressure") != std::string::npos);
    CHECK(problem([](auto& c) { c.mu_crush = 0.2; }).find("lock_compression") != std::string::npos);
    CHECK(problem([](auto& c) { c.p_crush = 1e6; }).find("steeper") != std::string::npos);
    CHECK(problem([](auto& c) { c.cohesion = 1, c.B = 4; }).find("closing") != std::string::npos);
    CHECK(problem([](auto& c) { c.K1 = 1e6, c.K2 = -1e9, c.K3 = 0; }).find("never reach") !=
          std::string::npos);
  }
}
