// SPDX-License-Identifier: GPL-3.0-or-later
// What every coupled law promises by itself, along walks through its states: the same bits for one
// point and eight, no dependence on the frame, flow that dissipates, a modulus that no change of
// volume exceeds. What its stage promises is in material_stages_test.cpp.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "every_law.hpp"
#include "krater/materials/returns/radial_return.hpp"
#include "krater/materials/returns/rates.hpp"

namespace {

using namespace krater;
using namespace krater::test;

/// What a model is told, lane by lane.
struct Told {
  Lanes s[6], strain, mu, energy, plastic;

  Told(std::mt19937& random, int number) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> unit;
    for (int i = 0; i < 8; ++i) {
      const double size = std::pow(10.0, 5.0 + 4.0 * unit(random));
      for (Lanes& k : s) k.v[i] = size * normal(random);
      s[2].v[i] = -s[0].v[i] - s[1].v[i];
      strain.v[i] = std::pow(10.0, -8.0 + 6.0 * unit(random));
      const double reach = number % 3 == 0 ? 1e-3 : 0.15;
      mu.v[i] = reach * (unit(random) - 0.3);
      energy.v[i] = 1e5 * unit(random);
      plastic.v[i] = unit(random);
    }
  }
  template <class Real>
  CoupledStep<Real> step(auto get) const {
    const Sym3<Real> trial{get(s[0]), get(s[1]), get(s[2]), get(s[3]), get(s[4]), get(s[5])};
    const Real rho = kCopper.density * (get(mu) + 1.0);
    return {trial,           equivalent_stress(trial),
            get(strain),     rho,
            Real(1.0) / rho, get(energy),
            get(plastic),    1e-8,
            Real(0.005)};
  }
};

double pressure_of(const auto& update, double energy) {
  return update.pressure.thermal * energy + update.pressure.cold;
}

/// The pressure at a density near that of a step, along the isentrope, from the state it ended in.
double pressure_beside(const auto& law, const CoupledStep<double>& end, double factor, double p) {
  CoupledStep<double> step = end;
  step.trial = zero_sym3<double>();
  step.q = 0;
  step.rho = end.rho * factor;
  step.v = 1.0 / step.rho;
  step.energy = end.energy - p * (step.v - end.v);
  return pressure_of(law.update(step), step.energy);
}

/// Calls `check(law, state of a lane, told, lane)` along a walk of eight points.
void walk(const auto& law, auto check) {
  std::mt19937 random{77};
  using State = decltype(law.initial_state());
  std::array<State, 8> states;
  states.fill(law.initial_state());
  for (int n = 0; n < 300; ++n) {
    if (n % 60 == 0) states.fill(law.initial_state());
    const Told told{random, n};
    check(states, told);
    for (unsigned i = 0; i < 8; ++i)
      states[i] =
          law.at(states[i]).update(told.step<double>([i](const Lanes& l) { return l.v[i]; })).state;
  }
}

}  // namespace

TEST_SUITE("contract") {
  TEST_CASE("models: one point and eight give the same bits") {
    for_each_law(AllLaws{}, Family::model, [](const auto& law) {
      if constexpr (Coupled<std::remove_cvref_t<decltype(law)>>) {
        walk(law, [&](const auto& states, const Told& told) {
          std::array<Pack, std::tuple_size_v<std::remove_cvref_t<decltype(states[0])>>> wide;
          for (unsigned k = 0; k < wide.size(); ++k) {
            Lanes lanes;
            for (unsigned i = 0; i < 8; ++i) lanes.v[i] = states[i][k];
            wide[k] = lanes.pack();
          }
          const auto eight =
              law.at(wide).update(told.step<Pack>([](const Lanes& l) { return l.pack(); }));
          for (int i = 0; i < 8; ++i) {
            const auto step = told.step<double>([i](const Lanes& l) { return l.v[i]; });
            const auto one = law.at(states[static_cast<unsigned>(i)]).update(step);
            REQUIRE(same(one.q, get(eight.q, i)));
            REQUIRE(same(one.plastic, get(eight.plastic, i)));
            REQUIRE(same(one.pressure.cold, get(eight.pressure.cold, i)));
            REQUIRE(same(one.pressure.thermal, get(eight.pressure.thermal, i)));
            REQUIRE(same(one.least, get(eight.least, i)));
            REQUIRE(same(one.modulus, get(eight.modulus, i)));
            REQUIRE(same(one.crush, get(eight.crush, i)));
            for (unsigned k = 0; k < wide.size(); ++k)
              REQUIRE(same(one.state[k], get(eight.state[k], i)));
            REQUIRE(one.failed == (((bits(eight.failed) >> i) & 1U) != 0));
          }
        });
      }
    });
  }

  TEST_CASE("models: flow dissipates, a turned trial gives the same, the modulus is a bound") {
    for_each_law(AllLaws{}, Family::model, [](const auto& law) {
      if constexpr (Coupled<std::remove_cvref_t<decltype(law)>>) {
        std::mt19937 random{5};
        std::normal_distribution<double> normal;
        double stiffest = 0, met = 0;
        walk(law, [&](const auto& states, const Told& told) {
          const Mat3<double> turn = polar_rotation(
              plus_identity(Mat3<double>{normal(random) * 0.2, normal(random) * 0.2, 0.3, 0.1,
                                         normal(random) * 0.2, -0.2, 0.2, 0.4, 0.1}));
          for (unsigned i = 0; i < 8; ++i) {
            const auto bound = law.at(states[i]);
            CoupledStep<double> step = told.step<double>([i](const Lanes& l) { return l.v[i]; });
            const auto update = bound.update(step);
            REQUIRE(update.q >= 0);
            REQUIRE(update.q <= step.q);
            REQUIRE(update.plastic >= 0);
            REQUIRE(update.least <= 0);
            REQUIRE(update.q * update.plastic * step.v + update.crush >= 0);
            CoupledStep<double> turned = step;
            turned.trial = push_forward(turn, step.trial);
            turned.q = equivalent_stress(turned.trial);
            const auto again = bound.update(turned);
            CHECK(std::fabs(again.q - update.q) <= 1e-12 * step.q);
            CHECK(pressure_of(again, step.energy) ==
                  doctest::Approx(pressure_of(update, step.energy)).epsilon(1e-12));

            const auto after = law.at(update.state);
            const double h = 1e-6, start = pressure_of(update, step.energy);
            const double p = pressure_beside(after, step, 1, start);
            const double modulus = after.update(step).modulus;
            const double loading = (pressure_beside(after, step, 1 + h, p) - p) / h,
                         unloading = (p - pressure_beside(after, step, 1 - h, p)) / h;
            CHECK(loading <= modulus * (1 + 1e-4));
            CHECK(unloading <= modulus * (1 + 1e-4));
            met = std::max(met, std::max(loading, unloading) / modulus);
            stiffest = std::max(stiffest, modulus);
          }
        });
        CHECK(met == doctest::Approx(1).epsilon(1e-4));  // a bound, not a guess
        CHECK(stiffest > law.rho0 * law.c0 * law.c0 * (1 - 1e-12));
        // At rest, nothing.
        const double v = 1 / law.rho0;
        const auto rest = law.at(law.initial_state())
                              .update({zero_sym3<double>(), 0, 0, law.rho0, v, 0, 0, 1e-8, 0.005});
        CHECK(pressure_of(rest, 0.0) == 0);
        CHECK(rest.state == law.initial_state());
        CHECK(rest.modulus == doctest::Approx(law.rho0 * law.c0 * law.c0).epsilon(1e-12));
      }
    });
  }
}
