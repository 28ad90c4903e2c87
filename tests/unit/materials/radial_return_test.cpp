// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/materials/returns/radial_return.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "krater/materials/strength/johnson_cook.hpp"
#include "krater/materials/strength/von_mises.hpp"

namespace {

using namespace krater;

constexpr double G = 46e9;
const MaterialConstants kCopper{8960.0, G, 294.0};

JohnsonCook copper() {
  const double values[] = {90e6, 292e6, 0.31, 0.025, 1.0, 1.09, 294.0, 1356.0};
  return make_law<JohnsonCook>(values, kCopper);
}

double log_uniform(std::mt19937& random, double low, double high) {
  return std::exp(std::uniform_real_distribution<double>{std::log(low), std::log(high)}(random));
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE(
      "radial return: residual below 1e-10 of yield over 1e5 random states, whatever the guess") {
    std::mt19937 random{11};
    std::uniform_real_distribution<double> unit;
    const JohnsonCook law = copper();
    double worst = 0.0;
    for (int i = 0; i < 100000; ++i) {
      const double dt = log_uniform(random, 1e-12, 1e-5);
      const double eps = unit(random) < 0.3 ? 0.0 : log_uniform(random, 1e-9, 10.0);
      const double T = unit(random) < 0.2 ? 1356.0 - log_uniform(random, 1e-9, 1.0)
                                          : 200.0 + 1200.0 * unit(random);
      const auto curve = law.at(T);
      const double still = curve.hardening(eps).stress;
      const double q = unit(random) < 0.5 ? still + 3.0 * G * log_uniform(random, 1e-12, 1.0)
                                          : still * (0.5 + log_uniform(random, 1e-6, 1e3));
      const double rate = unit(random) < 0.1 ? 0.0 : log_uniform(random, 1e-6, 1e9);
      const auto step = radial_return(curve, q, eps, G, rate * dt, dt);
      REQUIRE_FALSE(step.unconverged);
      REQUIRE(step.yielding == (q > still));
      if (!step.yielding) {
        REQUIRE(step.d == 0.0);
        continue;
      }
      REQUIRE(step.d >= 0.0);
      REQUIRE(step.d <= q / (3.0 * G) * (1.0 + 1e-15));
      const double sigma = flow_at(curve, eps + step.d, step.d / dt).stress;
      // The round-off of q itself is all that can be asked where strength is next to nothing.
      const double allowed = 1e-10 * sigma + 2e-15 * q;
      REQUIRE(std::fabs(q - 3.0 * G * step.d - sigma) <= allowed);
      REQUIRE(std::fabs(step.stress - sigma) <= allowed);
      worst = std::max(worst, std::fabs(q - 3.0 * G * step.d - sigma) / (sigma + 2e-5 * q));
    }
    MESSAGE("worst residual over yield: ", worst);
  }

  TEST_CASE("radial return: the kink at the reference rate is not stepped over") {
    // The root lies a hair above or below the reference rate, where the slope of sigma_Y jumps.
    const JohnsonCook law = copper();
    const double dt = 1e-6, eps = 0.1;
    const auto curve = law.at(400.0);
    for (int i = -40; i <= 40; ++i) {
      const double d = dt * law.epsdot0 * (1.0 + i * 1e-6);
      const double q = 3.0 * G * d + flow_at(curve, eps + d, d / dt).stress;
      for (const double guess : {0.5 * d, 0.999999 * d, 1.00001 * d, 30.0 * d}) {
        const auto step = radial_return(curve, q, eps, G, guess, dt);
        const double sigma = flow_at(curve, eps + step.d, step.d / dt).stress;
        CHECK(std::fabs(q - 3.0 * G * step.d - sigma) <= 1e-10 * sigma);
      }
    }
  }

  TEST_CASE(
      "radial return: linear hardening has its closed form; a molten point loses all stress") {
    const double values[] = {157e6, 425e6};
    const auto curve = make_law<VonMises>(values, kCopper).at(0.0);
    for (const double over : {1e-9, 1e-3, 1.0, 100.0}) {
      const double eps = 0.2;
      const double still = 157e6 + 425e6 * eps;
      const double q = still * (1.0 + over);
      const auto step = radial_return(curve, q, eps, G, 1e-4, 1e-7);
      CHECK(step.d == doctest::Approx(still * over / (3.0 * G + 425e6)).epsilon(1e-7));
    }
    const auto molten = radial_return(copper().at(1356.0), 5e8, 0.1, G, 1e-3, 1e-8);
    CHECK(molten.yielding);
    CHECK(molten.stress == 0.0);
    CHECK(molten.d == doctest::Approx(5e8 / (3.0 * G)));
    const auto nothing = radial_return(copper().at(1400.0), 0.0, 0.1, G, 1e-3, 1e-8);
    CHECK_FALSE(nothing.yielding);
    CHECK(nothing.d == 0.0);
  }

  TEST_CASE("radial return: NaN is reported as no convergence, never taken for elastic") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(radial_return(copper().at(nan), 1e8, 0.1, G, 1e-3, 1e-8).unconverged);
    CHECK(radial_return(copper().at(300.0), nan, 0.1, G, 1e-3, 1e-8).unconverged);
    CHECK(radial_return(copper().at(300.0), 1e8, nan, G, 1e-3, 1e-8).unconverged);
  }

  TEST_CASE("Johnson-Cook: published limits") {
    const JohnsonCook law = copper();
    for (const double eps : {1e-6, 0.01, 0.3, 2.0}) {
      const double still = 90e6 + 292e6 * std::pow(eps, 0.31);
      const auto cold = law.at(294.0);
      // The static curve at and below the reference rate (not 2^C times it, as one code had it).
      CHECK(cold.hardening(eps).stress == doctest::Approx(still).epsilon(1e-13));
      CHECK(flow_at(cold, eps, 1.0).stress == doctest::Approx(still).epsilon(1e-13));
      CHECK(flow_at(cold, eps, 1e-3).stress == doctest::Approx(still).epsilon(1e-13));
      CHECK(flow_at(cold, eps, 1e4).stress ==
            doctest::Approx(still * (1.0 + 0.025 * std::log(1e4))).epsilon(1e-13));
      CHECK(flow_at(law.at(200.0), eps, 1.0).stress == flow_at(cold, eps, 1.0).stress);
      const double warm = std::pow((800.0 - 294.0) / (1356.0 - 294.0), 1.09);
      CHECK(flow_at(law.at(800.0), eps, 1.0).stress ==
            doctest::Approx(still * (1.0 - warm)).epsilon(1e-13));
      CHECK(flow_at(law.at(1356.0), eps, 1e6).stress == 0.0);
      CHECK(flow_at(law.at(9000.0), eps, 1e6).stress == 0.0);
    }
    CHECK(law.at(294.0).hardening(0.0).stress == 90e6);
    CHECK(law.problem() == nullptr);
  }
}
