// SPDX-License-Identifier: GPL-3.0-or-later
// heating: energy against closed isentropes, quadrature, thermodynamics and a shock.
#include "krater/materials/heating/internal_energy.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "contract/material_support.hpp"
#include "krater/materials/heating/isentrope.hpp"
#include "krater/materials/law_list.hpp"

namespace {

using namespace krater;
using namespace krater::test;

template <class Law>
Law typical() {
  const auto values =
      typical_parameters(catalogue().at(static_cast<std::size_t>(find_law("eos", Law::name))));
  return make_law<Law>(values.data(), kCopper);
}

template <class Law>
std::unique_ptr<Isentrope> isentrope_of(const Law& law, double T_ref = 294.0) {
  auto result = std::make_unique<Isentrope>();
  result->tabulate(law, T_ref);
  return result;
}

/// e_s = exp(Gamma0 eta) int_0^eta exp(-Gamma0 y) A(y)/rho0 dy where Gamma rho is constant.
template <class Law>
double quadrature(const Law& law, double eta) {
  const int n = 2000;  // Simpson
  double sum = 0.0;
  for (int i = 0; i <= n; ++i) {
    const double y = eta * i / n, rho = law.rho0 / (1.0 - y);
    sum += (i == 0 || i == n ? 1
            : i % 2 == 1     ? 4
                             : 2) *
           std::exp(-law.gamma0 * y) * law.split(rho, 1.0 / rho).cold / law.rho0;
  }
  return std::exp(law.gamma0 * eta) * sum * eta / n / 3.0;
}

/// d T along a step of a true isentrope from (rho, e), over -Gamma T dv/v.
template <class Law>
double isentropic_ratio(const Law& law, const Isentrope& s, double c_v, double rho, double e) {
  const auto temperature = [&](double r, double energy) {
    const auto reference = s.at(r / law.rho0 - 1.0);
    return reference.temperature + (energy - reference.energy) / c_v;
  };
  const double h = 1e-4;
  const auto along = [&](double factor) {
    // Runge-Kutta of fourth order in ln rho: de = p v d ln rho.
    const double du = std::log(factor);
    const auto slope = [&](double u, double energy) {
      const double r = rho * std::exp(u);
      return pressure_at(law, r, 1.0 / r, energy) / r;
    };
    const double a = slope(0, e), b = slope(0.5 * du, e + 0.5 * du * a),
                 c = slope(0.5 * du, e + 0.5 * du * b), d = slope(du, e + du * c);
    return temperature(rho * factor, e + du / 6.0 * (a + 2.0 * (b + c) + d));
  };
  const double slope = (along(1.0 + h) - along(1.0 / (1.0 + h))) / (2.0 * std::log(1.0 + h));
  const double Gamma = split_at(law, rho, 1.0 / rho, e).thermal / rho;
  return slope / (Gamma * temperature(rho, e));
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("isentrope: the closed temperatures, the quadrature of theory 8") {
    const auto shock = typical<MieGruneisenShock>();
    const auto polynomial = typical<MieGruneisenPolynomial>();
    const auto s = isentrope_of(shock), p = isentrope_of(polynomial);
    for (const double x : {1.0001, 1.01, 1.2, 1.5, 1.9, 2.1}) {
      const double eta = 1.0 - 1.0 / x, T = 294.0 * std::exp(2.02 * eta);
      CAPTURE(x);
      CHECK(s->at(x - 1.0).temperature == doctest::Approx(T).epsilon(1e-7));
      CHECK(p->at(x - 1.0).temperature == doctest::Approx(T).epsilon(1e-7));
      const double small = std::max(2e-7 * shock.c0 * shock.c0, 1e-6 * quadrature(shock, eta));
      CHECK(std::fabs(s->at(x - 1.0).energy - quadrature(shock, eta)) < small);
      CHECK(std::fabs(p->at(x - 1.0).energy - quadrature(polynomial, eta)) < small);
    }
    for (const double x : {0.999, 0.9, 0.5, 0.1, 1e-3})
      CHECK(s->at(x - 1.0).temperature == doctest::Approx(294.0 * std::pow(x, 2.02)).epsilon(1e-7));
    // Expansion of the shock form: e_s = K v/(1 + Gamma) - K v0/Gamma + C v^-Gamma, e_s(v0) = 0.
    for (const double x : {0.999, 0.9, 0.5, 0.1}) {
      const double K = shock.modulus / shock.rho0, G = shock.gamma0;
      const double closed =
          K * ((1.0 / x) / (1.0 + G) - 1.0 / G + std::pow(x, G) / (G * (1.0 + G)));
      CHECK(std::fabs(s->at(x - 1.0).energy - closed) < 1e-8 * K + 1e-7 * closed);
    }
    CHECK(s->at(0.0).temperature == 294.0);
    CHECK(s->at(0.0).energy == 0.0);
    const auto gas = typical<IdealGas>();
    const auto g = isentrope_of(gas, 300.0);
    for (const double x : {1e-3, 0.2, 3.0, 10.0}) {
      CHECK(g->at(x - 1.0).temperature == doctest::Approx(300.0 * std::pow(x, 0.4)).epsilon(1e-7));
      CHECK(g->at(x - 1.0).energy ==
            doctest::Approx(gas.initial_energy * std::pow(x, 0.4)).epsilon(1e-7));
    }
    CHECK(std::isnan(s->at(std::nan("")).temperature));
    CHECK(s->at(1e9).temperature > 0.0);
    CHECK(s->at(-1.0).temperature > 0.0);
  }

  TEST_CASE("heating by energy: dT = -Gamma T dv/v along any isentrope (finite differences)") {
    const auto check = [](const auto& law) {
      const auto s = isentrope_of(law);
      CAPTURE(std::string{law.name});
      for (const double x : {0.9, 0.97, 1.02, 1.3, 1.7})
        for (const double added : {0.0, 2e5, 5e6}) {
          const double e = s->at(x - 1.0).energy + added;
          CHECK(isentropic_ratio(law, *s, 383.0, x * law.rho0, e) ==
                doctest::Approx(1.0).epsilon(1e-3));
        }
    };
    check(typical<MieGruneisenShock>());
    check(typical<MieGruneisenPolynomial>());
    check(typical<IdealGas>());
    check(typical<StiffenedGas>());
    check(typical<Jwl>());
    const auto tillotson = typical<Tillotson>();  // on the isentrope itself
    const auto s = isentrope_of(tillotson);
    for (const double x : {0.97, 1.02, 1.3})
      CHECK(isentropic_ratio(tillotson, *s, 383.0, x * tillotson.rho0, s->at(x - 1.0).energy) ==
            doctest::Approx(1.0).epsilon(0.02));
  }

  TEST_CASE("heating by energy: ideal gas e = c_v T, jwl e = e_cold + c_v T, everywhere") {
    const auto gas = typical<IdealGas>();
    const auto jwl = typical<Jwl>();
    const double c_v = 1000.0;
    const auto g = isentrope_of(gas, gas.thermal_energy() / c_v);
    const auto j = isentrope_of(jwl, jwl.thermal_energy() / c_v);
    for (const double x : {0.05, 0.4, 1.0, 1.6, 2.5})
      for (const double e : {1e5, 1e6, 2e7}) {
        const auto a = g->at(x - 1.0), b = j->at(x - 1.0);
        CHECK(a.temperature + (e - a.energy) / c_v == doctest::Approx(e / c_v).epsilon(1e-6));
        const double V = 1.0 / x, cold = (jwl.A / jwl.R1 * std::exp(-jwl.R1 * V) +
                                          jwl.B / jwl.R2 * std::exp(-jwl.R2 * V)) /
                                         jwl.rho0;
        const double T = (e - cold) / c_v;
        CHECK(std::fabs(b.temperature + (e - b.energy) / c_v - T) <
              1e-6 * (std::fabs(T) + cold / c_v));
      }
  }

  TEST_CASE("heating by energy: aluminium on its Hugoniot at eta = .37 is at 4451 K") {
    // 2024: 2785 kg/m^3, 5328 m/s, 1.338, Gamma0 2.0, 875 J/(kg K), 300 K.
    const double values[] = {5328.0, 1.338, 2.0};
    const auto law = make_law<MieGruneisenShock>(values, {2785.0, 26e9, 300.0});
    const auto s = isentrope_of(law, 300.0);
    const double eta = 0.37, v = (1.0 - eta) / 2785.0;
    const double p = 2785.0 * 5328.0 * 5328.0 * eta / std::pow(1.0 - 1.338 * eta, 2);
    const double e = 0.5 * p * (1.0 / 2785.0 - v);
    const auto reference = s->at(1.0 / (1.0 - eta) - 1.0);
    CHECK(reference.temperature + (e - reference.energy) / 875.0 ==
          doctest::Approx(4451.0).epsilon(1e-4));
  }

  TEST_CASE("heating by energy: the solid's density where the carried pressure is not p~") {
    const auto check = [](const auto& law) {
      CAPTURE(std::string{law.name});
      for (const double x : {1e-3, 0.1, 0.6, 0.95, 1.0, 1.05})
        for (const double p : {-2e9, 0.0, 1e9})
          for (const double e : {0.0, 1e5, 1e6}) {
            const double rho = solid_density(law, x * law.rho0, p, e);
            CHECK(std::fabs(pressure_at(law, rho, 1.0 / rho, e) - p) <
                  1e-9 * law.rho0 * law.c0 * law.c0);
          }
    };
    check(typical<LinearEos>());
    check(typical<MieGruneisenShock>());
    check(typical<MieGruneisenPolynomial>());
    // Its own pressure: untouched, bit for bit.
    const auto law = typical<MieGruneisenShock>();
    const double rho = 1.2 * law.rho0;
    CHECK(solid_density(law, rho, pressure_at(law, rho, 1.0 / rho, 1e6), 1e6) == rho);
  }

  TEST_CASE("heating by energy: plastic and viscous work heat, elastic deformation does not") {
    const auto shear = [](Body& body, int steps, double by) {
      for (int n = 0; n < steps; ++n) {
        for (int k = 0; k < 9; ++k) body.local("step_gradient", 0, k) = k == 1 ? by : 0.0;
        body.step(1e-8);
      }
    };
    const Recipe thermal{.strength = "johnson_cook",
                         .eos = "mie_gruneisen_shock",
                         .viscosity = false,
                         .thermal = true};
    Body body{*stage_factory_isa_portable(), thermal, 1, 1};
    shear(body, 10, 1e-5);
    CHECK(body.state("plastic_strain", 0) == 0.0);
    CHECK(body.state("internal_energy", 0) > 0.0);
    CHECK(body.state("temperature", 0) == doctest::Approx(294.0).epsilon(1e-10));
    shear(body, 2000, 1e-3);
    // All plastic work, not 0.9 of it; the pressure of the heat at constant volume takes none.
    const double heat = 383.0 * (body.state("temperature", 0) - 294.0);
    CHECK(heat * body.state("mass", 0) == doctest::Approx(body.ledger.plastic_work).epsilon(2e-3));
    CHECK(body.state("temperature", 0) > 400.0);
    Body soft{*stage_factory_isa_portable(), thermal, 1, 1};
    soft.state("internal_energy", 0) = 383.0 * 500.0;  // strength reads it
    soft.state("pressure", 0) = 2.02 * 8960.0 * 383.0 * 500.0;
    shear(soft, 2, 1e-3);
    Body cold{*stage_factory_isa_portable(), thermal, 1, 1};
    shear(cold, 2, 1e-3);
    CHECK(soft.state("temperature", 0) == doctest::Approx(794.0).epsilon(1e-3));
    CHECK(soft.state("deviatoric_stress", 0, 5) < 0.65 * cold.state("deviatoric_stress", 0, 5));
    CHECK(body.layout().find("temperature") != nullptr);
    const Recipe none{.strength = "von_mises", .eos = "mie_gruneisen_shock"};
    CHECK(Body{*stage_factory_isa_portable(), none, 1, 1}.layout().find("temperature") == nullptr);
  }

  TEST_CASE("heating by energy: a spalled point is as hot as its solid part") {
    Recipe recipe{.strength = "johnson_cook",
                  .eos = "mie_gruneisen_shock",
                  .viscosity = false,
                  .spall_strength = 1e9,
                  .thermal = true};
    Body body{*stage_factory_isa_portable(), recipe, 1, 1};
    body.state("internal_energy", 0) = 383.0 * 400.0;
    body.state("pressure", 0) = 2.02 * 8960.0 * 383.0 * 400.0;
    for (int n = 0; n < 600; ++n) {
      for (const int k : {0, 4, 8}) body.local("step_gradient", 0, k) = 1e-3;
      body.step(1e-8);
    }
    REQUIRE(body.state("density", 0) < 0.2 * 8960.0);
    REQUIRE(body.state("pressure", 0) == -1e9);
    // rho0 c0^2 (x - 1) + Gamma rho0 x e = -1e9 is the solid's density; then the closed isentrope.
    const double K = 8960.0 * 3940.0 * 3940.0, G = 2.02, e = body.state("internal_energy", 0);
    const double x = (K - 1e9) / (K + G * 8960.0 * e);
    const double e_s =
        K / 8960.0 * ((1.0 / x) / (1.0 + G) - 1.0 / G + std::pow(x, G) / (G * (1.0 + G)));
    CHECK(body.state("temperature", 0) ==
          doctest::Approx(294.0 * std::pow(x, G) + (e - e_s) / 383.0).epsilon(1e-5));
    CHECK(body.state("temperature", 0) > 1500.0);  // work against the spall strength
  }

  TEST_CASE("heating by energy: a failed fragment that flies apart keeps its temperature") {
    Recipe recipe{.strength = "von_mises",
                  .eos = "mie_gruneisen_shock",
                  .viscosity = false,
                  .damage = "maximum_plastic_strain",
                  .thermal = true};
    Body body{*stage_factory_isa_portable(), recipe, 1, 1};
    for (int n = 0; n < 100; ++n) {
      for (int k = 0; k < 9; ++k) body.local("step_gradient", 0, k) = k == 0 ? 1e-3 : 0.0;
      body.step(1e-8);
    }
    REQUIRE(body.state("failed", 0) == 1.0);
    const double before = body.state("temperature", 0);
    CHECK(before > 300.0);
    for (int n = 0; n < 400; ++n) {
      for (const int k : {0, 4, 8}) body.local("step_gradient", 0, k) = 5e-3;
      body.step(1e-8);
    }
    CHECK(body.state("density", 0) < 0.01 * 8960.0);
    CHECK(body.state("temperature", 0) == doctest::Approx(before).epsilon(1e-9));
  }
}
