// SPDX-License-Identifier: GPL-3.0-or-later
// The scalar equation of plasticity for every yield law of the catalogue, and the energy of every
// material: what the stages book is the work of the stresses that they carry.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "krater/materials/law_list.hpp"
#include "krater/materials/returns/rate_return.hpp"
#include "material_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

struct Dice {
  std::mt19937 random{17};
  double unit() { return std::uniform_real_distribution<double>{}(random); }
  double between(double low, double high) {
    return std::exp(std::log(low) + (std::log(high) - std::log(low)) * unit());
  }
};

/// Calls `check(law)` for every yield law with typical parameters.
template <class Check, class... Laws>
void for_each_yield_law(LawList<Laws...>, Check check) {
  const auto one = [&]<class Law>(const Law*) {
    if constexpr (Yielding<Law>) {
      const int index = find_law("strength", Law::name);
      const auto values = typical_parameters(catalogue().at(static_cast<std::size_t>(index)));
      check(make_law<Law>(values.data(), kCopper));
    }
  };
  (one(static_cast<const Laws*>(nullptr)), ...);
}

/// A random state: eps = 0, T at and about the melting points of the typical laws, rates 0 to 1e9.
struct RandomState {
  double dt, eps, rate, q;
  StartState<double> start;
};
template <class Law>
RandomState random_state(Dice& dice, const Law& law, double G) {
  RandomState s;
  s.dt = dice.between(1e-12, 1e-5);
  s.eps = dice.unit() < 0.3 ? 0.0 : dice.between(1e-9, 10.0);
  const double melting = dice.unit() < 0.5 ? 1356.0 : 1790.0;
  s.start = {dice.unit() < 0.3 ? melting - dice.between(1e-9, 1.0) : 200.0 + 1700.0 * dice.unit()};
  if (dice.unit() < 0.7)
    s.start.pressure = -1e9 + 50e9 * dice.unit(), s.start.compression = 0.95 + 0.4 * dice.unit();
  s.rate = dice.unit() < 0.1 ? 0.0 : dice.between(1e-6, 1e9);
  const double still = curve_at(law, s.start).hardening(s.eps).stress;
  s.q = dice.unit() < 0.5 ? still + 3.0 * G * dice.between(1e-12, 1.0)
                          : still * (0.5 + dice.between(1e-6, 1e3));
  return s;
}

double value_or_zero(Body& body, const char* field, int point, int k = 0) {
  return body.layout().find(field) == nullptr ? 0.0 : body.state(field, point, k);
}

/// s : dE of the strain of the last step, `s` the sum over both ends.
double contracted(const std::vector<double>& s, Body& body, int point) {
  double sum = 0.0;
  for (int k = 0; k < 6; ++k)
    sum +=
        (k < 3 ? 1.0 : 2.0) * s[static_cast<std::size_t>(k)] * body.local("strain_step", point, k);
  return sum;
}

}  // namespace

TEST_SUITE("contract") {
  TEST_CASE("returns: residual within 1e-10 of yield over 1e5 random states of every yield law") {
    constexpr double G = 46e9;
    for_each_yield_law(AllLaws{}, [&](const auto& law) {
      CAPTURE(std::string{law.name});
      Dice dice;
      int molten = 0, yielding = 0;
      for (int i = 0; i < 100000; ++i) {
        const RandomState s = random_state(dice, law, G);
        const auto curve = curve_at(law, s.start);
        const double still = curve.hardening(s.eps).stress;
        molten += still == 0.0 ? 1 : 0;
        const auto step = radial_return(curve, s.q, s.eps, G, s.rate * s.dt, s.dt);
        REQUIRE_FALSE(step.unconverged);
        REQUIRE(step.yielding == (s.q > still));
        if (!step.yielding) continue;
        ++yielding;
        const double sigma = flow_at(curve, s.eps + step.d, step.d / s.dt).stress;
        // The round-off of q itself is all that can be asked where strength is next to nothing.
        REQUIRE(std::fabs(s.q - 3.0 * G * step.d - sigma) <= 1e-10 * sigma + 2e-15 * s.q);
      }
      CHECK(yielding > 50000);
      if (law.reads_temperature && std::string{law.name}.find("zerilli") == std::string::npos)
        CHECK(molten > 1000);
    });
  }

  TEST_CASE(
      "returns with damage: the same over phi up to phi_c; the smallest root or snapped back") {
    constexpr double G = 46e9;
    for_each_yield_law(AllLaws{}, [&](const auto& law) {
      CAPTURE(std::string{law.name});
      Dice dice;
      int snapped = 0, capped = 0;
      for (int i = 0; i < 100000; ++i) {
        const RandomState s = random_state(dice, law, G);
        const auto curve = curve_at(law, s.start);
        const double phi_c = dice.unit() < 0.5 ? 0.999 : 0.05 + 0.9 * dice.unit();
        const double phi = dice.unit() < 0.3 ? 0.0 : phi_c * (1.0 - dice.between(1e-12, 1.0));
        const Growth<double> growth{dice.between(1e-3, 1e4),
                                    dice.unit() < 0.5 ? 0.0 : s.eps * 2.0 * dice.unit(), phi_c};
        const auto [step, snap] =
            rate_return(curve, s.q, s.eps, G, phi, growth, s.rate * s.dt, s.dt);
        REQUIRE_FALSE(step.unconverged);
        if (!step.yielding) continue;
        const double sigma = flow_at(curve, s.eps + step.d, step.d / s.dt).stress;
        const double after = damage_after(growth, phi, s.eps + step.d, step.d);
        const double carried = (1.0 - after) / (1.0 - phi) * sigma;
        REQUIRE(std::fabs(s.q - 3.0 * G * step.d - carried) <= 1e-10 * carried + 2e-15 * s.q);
        REQUIRE(after <= phi_c);
        capped += after == phi_c ? 1 : 0;
        snapped += snap ? 1 : 0;
      }
      CHECK(snapped > 100);
      CHECK(capped > 1000);
    });
  }

  TEST_CASE("materials: the internal energy is the work of the carried stresses, every recipe") {
    constexpr int points = 24;
    for (const Recipe& recipe : all_recipes()) {
      if (recipe.eos.empty()) continue;  // its energy is that of F
      CAPTURE(describe(recipe));
      Body body{*stage_factory_isa_portable(), recipe, points, points};
      std::vector<double> work(points, 0.0), traffic(points, 0.0), start;
      for (int i = 0; i < points; ++i) start.push_back(body.state("internal_energy", i));
      // Out and back: compressed and sheared, then pulled until what can fail has failed.
      for (int n = 0; n < 80; ++n) {
        set_motion(body, n < 40 ? n : 79 - n, n < 40 ? 6e-4 : -6e-4);
        std::vector<std::vector<double>> s(points, std::vector<double>(6));
        std::vector<double> p(points);
        const auto add = [&](int i) {
          for (int k = 0; k < 6; ++k)
            s[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)] +=
                value_or_zero(body, "deviatoric_stress", i, k);
          p[static_cast<std::size_t>(i)] +=
              body.state("pressure", i) + value_or_zero(body, "viscous_pressure", i);
        };
        for (int i = 0; i < points; ++i) add(i);
        body.step(1e-8);
        for (int i = 0; i < points; ++i) {
          const auto at = static_cast<std::size_t>(i);
          add(i);
          const double v0 = body.local("specific_volumes", i, 0),
                       v1 = body.local("specific_volumes", i, 1);
          const double volume = -0.5 * p[at] * (v1 - v0);
          const double shape = 0.25 * (v0 + v1) * contracted(s[at], body, i);
          work[at] += volume + shape;
          traffic[at] += std::fabs(volume) + std::fabs(shape);
        }
      }
      REQUIRE(body.fault.kind == FaultKind::none);
      for (int i = 0; i < points; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const double gained = body.state("internal_energy", i) - start[at];
        CHECK(std::fabs(gained - work[at]) <
              1e-11 * traffic[at] + 80 * 2.3e-16 * std::fabs(body.state("internal_energy", i)));
      }
    }
  }
}
