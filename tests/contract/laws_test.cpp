// SPDX-License-Identifier: GPL-3.0-or-later
// What every law of the catalogue promises by itself: derivatives, bounds, and the same bits for
// one point and eight.
#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <set>

#include "every_law.hpp"
#include "krater/core/lane_math.hpp"
#include "krater/materials/law_list.hpp"
#include "krater/materials/returns/rates.hpp"
#include "krater/materials/stages/eos_stage.hpp"
#include "krater/materials/stages/kinematics_stage.hpp"
#include "krater/materials/stages/signal_speed_stage.hpp"
#include "krater/materials/stages/strength_stage.hpp"

namespace {

using namespace krater;
using namespace krater::test;

double pressure(const auto& eos, double rho, double e) {
  return pressure_at(eos, rho, 1.0 / rho, e);
}

/// Slopes of a flow curve by finite differences, its order and its sign.
void check_slopes(const auto& curve) {
  for (const double eps : {1e-5, 1e-3, 0.1, 3.0}) {
    for (const double rate : {1e-3, 0.5, 2.0, 1e4, 1e9}) {
      const auto flow = flow_at(curve, eps, rate);
      const double h = 1e-5;
      const auto up = flow_at(curve, eps * (1.0 + h), rate),
                 down = flow_at(curve, eps * (1.0 - h), rate);
      CHECK((up.stress - down.stress) / (2.0 * h * eps) ==
            doctest::Approx(flow.d_eps).epsilon(1e-6));
      const double bend = (up.d_eps - down.d_eps) / (2.0 * h * eps);
      CHECK(std::fabs(bend) == doctest::Approx(flow.bend).epsilon(1e-5));
      const double faster = flow_at(curve, eps, rate * (1.0 + h)).stress;
      const double slower = flow_at(curve, eps, rate * (1.0 - h)).stress;
      CHECK(std::fabs((faster - slower) / (2.0 * h * rate) - flow.d_rate) <
            1e-6 * flow.d_rate + 1e-9 * flow.stress / rate + 1e-300);
      CHECK(flow.stress >= 0.0);
      CHECK(flow.stress >= curve.hardening(eps).stress * (1.0 - 1e-15));
      CHECK(flow.d_eps >= 0.0);
      CHECK(flow.d_rate >= 0.0);
    }
  }
}

}  // namespace

TEST_SUITE("contract") {
  TEST_CASE("catalogue: names, texts and parameters are complete and unambiguous") {
    std::set<std::string> names;
    for (const LawInfo& law : catalogue()) {
      CAPTURE(law.name);
      CHECK(names.insert(law.family + '.' + law.name).second);
      CHECK_FALSE(law.equation.empty());
      CHECK_FALSE(law.reference.empty());
      std::set<std::string> keys;
      for (const ParameterInfo& p : law.parameters) {
        CHECK(keys.insert(p.key).second);
        if (p.alias != nullptr) CHECK(keys.insert(p.alias).second);
        CHECK(std::string{p.meaning}.size() > 3);
        CHECK(std::string{p.unit}.size() > 0);
      }
      const auto values = typical_parameters(law);
      CHECK(law_problem(find_law(law.family, law.name), values.data(), kCopper) == nullptr);
      // Or it makes one of its own constants.
      const int index = find_law(law.family, law.name);
      const bool own = own_shear_modulus(index, values.data(), kCopper).has_value();
      CHECK((law.needs_shear_modulus || own) ==
            (law.family == "strength" || law.family == "model"));
      CHECK(!(law.needs_shear_modulus && own));
      for (const ParameterInfo& p : law.parameters) {
        if (p.words != nullptr)
          CHECK(static_cast<std::size_t>(p.fallback) < parameter_words(p).size());
      }
    }
    CHECK(find_law("strength", "jonson_cook") == -1);
    CHECK(find_law("eos", "johnson_cook") == -1);
    const double inverted[] = {90e6, 292e6, 0.31, 0.025, 1.0, 1.09, 1400.0, 1356.0};
    CHECK(law_problem(find_law("strength", "johnson_cook"), inverted, kCopper) != nullptr);
  }

  TEST_CASE("strength: slopes by finite differences, monotone, bounded below by zero") {
    for_each_law(AllLaws{}, Family::strength, [](const auto& law) {
      using Law = std::remove_cvref_t<decltype(law)>;
      if constexpr (Yielding<Law>) {
        CAPTURE(std::string{Law::name});
        const bool pressed = ReadsPressure<Law>;
        for (const double T : {200.0, 294.0, 500.0, 1300.0, 1355.9}) {
          check_slopes(curve_at(law, StartState<double>{T}));
          if (pressed) check_slopes(curve_at(law, StartState<double>{T, 40e9, 1.2}));
          if (pressed) check_slopes(curve_at(law, StartState<double>{T, -1e9, 0.99}));
        }
      }
    });
  }

  TEST_CASE("eos: K_s by finite differences along the isentrope, on both branches") {
    for_each_law(AllLaws{}, Family::eos, [](const auto& eos) {
      using Law = std::remove_cvref_t<decltype(eos)>;
      // A law with history has tests of its own (unit/materials/p_alpha).
      if constexpr (requires { eos.c0; } && !OwnsState<Law>) {
        CAPTURE(std::string{Law::name});
        for (const double x : {0.52, 0.6, 0.7, 0.79, 0.9, 0.999, 1.001, 1.1, 1.4, 1.9, 2.6}) {
          for (const double added : {-1e5, 0.0, 1e5, 5e6, 2e7}) {
            const double e = energy_at_start(eos) + added;
            const double rho = x * eos.rho0, v = 1.0 / rho;
            const double p = pressure(eos, rho, e);
            // de = -p dv to second order, then a difference of p(rho, e) to one side, of second
            // order: K = rho dp/drho at constant entropy. Where p has a bend (tillotson: E_iv,
            // E_cv, and e = 0 where cohesion fades) the law's value is that of one of the sides.
            const double h = 1e-5;
            const auto along = [&](double factor) {
              const double r = rho * factor, dv = 1.0 / r - v;
              double energy = e - p * dv;
              for (int k = 0; k < 3; ++k) energy = e - 0.5 * (p + pressure(eos, r, energy)) * dv;
              return pressure(eos, r, energy);
            };
            const auto one_sided = [&](double d) {
              return (4.0 * along(1.0 + d) - along(1.0 + 2.0 * d) - 3.0 * p) / (2.0 * d);
            };
            const double K = eos.bulk_modulus(rho, v, p, e);
            const double up = one_sided(h), down = one_sided(-h);
            CHECK(
                K ==
                doctest::Approx(std::fabs(K - up) < std::fabs(K - down) ? up : down).epsilon(1e-6));
            if (e != 0.0) CHECK(up == doctest::Approx(down).epsilon(1e-5));
          }
        }
        const double e0 = energy_at_start(eos), p0 = pressure_at_start(eos);
        if (e0 == 0.0) CHECK(p0 == 0.0);
        CHECK(eos.bulk_modulus(eos.rho0, 1.0 / eos.rho0, p0, e0) ==
              doctest::Approx(eos.rho0 * eos.c0 * eos.c0).epsilon(1e-12));
      }
    });
  }

  TEST_CASE(
      "hyperelastic: stress is the derivative of the energy; wave speed of uniaxial stretch") {
    const NeoHookean law = typical<NeoHookean>();
    std::mt19937 random{21};
    std::normal_distribution<double> normal{0.0, 0.2};
    for (int n = 0; n < 50; ++n) {
      Mat3<double> F = identity3<double>();
      for (double* c : {&F.xx, &F.xy, &F.xz, &F.yx, &F.yy, &F.yz, &F.zx, &F.zy, &F.zz})
        *c += normal(random);
      if (det(F) < 0.2) continue;
      const auto r = law(F);
      // W((I + h D) F) changes by h J sigma : D.
      for (int k = 0; k < 6; ++k) {
        Sym3<double> D = zero_sym3<double>();
        (&D.xx)[k] = 1.0;
        const double h = 1e-6;
        const auto energy = [&](double step) {
          Mat3<double> f = identity3<double>();
          f.xx += step * D.xx, f.yy += step * D.yy, f.zz += step * D.zz;
          f.yz += step * D.yz, f.zy += step * D.yz, f.xz += step * D.xz;
          f.zx += step * D.xz, f.xy += step * D.xy, f.yx += step * D.xy;
          return law(f * F).energy * law.rho0;
        };
        const double slope = (energy(h) - energy(-h)) / (2.0 * h);
        const double stress = contract(r.s, D) - r.pressure * trace(D);
        CHECK(std::fabs(slope - det(F) * stress) < 1e-6 * (law.G + law.lame_lambda));
      }
    }
    for (const double l : {0.6, 1.0, 1.5}) {
      Mat3<double> F = identity3<double>();
      F.xx = l;
      const auto stress = [&](double stretch) {
        F.xx = stretch;
        const auto r = law(F);
        return r.s.xx - r.pressure;
      };
      const double h = 1e-6;
      // rho c_L^2 = l d sigma/d l in uniaxial strain (P = sigma there).
      const double modulus = l * (stress(l * (1.0 + h)) - stress(l * (1.0 - h))) / (2.0 * h * l);
      F.xx = l;
      const double bound = law(F).modulus + 4.0 / 3.0 * law.G;
      CHECK(bound >= modulus * (1.0 - 1e-6));
      if (l >= 1.0) CHECK(bound == doctest::Approx(modulus).epsilon(1e-6));
    }
  }

  TEST_CASE("laws: one point and eight give the same bits") {
    std::mt19937 random{31};
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> unit;
    constexpr double dt = 1e-8, G = 46e9;
    for (int n = 0; n < 200; ++n) {
      Lanes a[9], s[6], eps, T, e, rho;
      for (int i = 0; i < 8; ++i) {
        const double size = std::pow(10.0, -1.0 - 5.0 * unit(random));
        for (Lanes& k : a) k.v[i] = size * normal(random);
        for (Lanes& k : s) k.v[i] = 1e8 * normal(random);
        s[2].v[i] = -s[0].v[i] - s[1].v[i];
        eps.v[i] = i % 3 == 0 ? 0.0 : unit(random);
        T.v[i] = 200.0 + 1300.0 * unit(random);
        e.v[i] = 8e6 * unit(random);
        rho.v[i] = 8960.0 * (0.7 + unit(random));
      }
      const auto matrix = [&](auto get) -> Mat3<decltype(get(a[0]))> {
        return {get(a[0]), get(a[1]), get(a[2]), get(a[3]), get(a[4]),
                get(a[5]), get(a[6]), get(a[7]), get(a[8])};
      };
      const auto stress = [&](auto get) -> Sym3<decltype(get(a[0]))> {
        return {get(s[0]), get(s[1]), get(s[2]), get(s[3]), get(s[4]), get(s[5])};
      };
      const auto wide = [](const Lanes& l) { return l.pack(); };
      for (int i = 0; i < 8; ++i) {
        const auto lane = [i](const Lanes& l) { return l.v[i]; };
        const Mat3<double> dtL = matrix(lane);
        const Sym3<double> dE = strain_step(dtL);
        const Sym3<Pack> dE8 = strain_step(matrix(wide));
        REQUIRE(same(dE.xy, get(dE8.xy, i)));
        REQUIRE(same(volume_step(dtL, 0.001).j_bar,
                     get(volume_step(matrix(wide), Pack(0.001)).j_bar, i)));
        REQUIRE(same(trial_deviator(stress(lane), dtL, G).yy,
                     get(trial_deviator(stress(wide), matrix(wide), G).yy, i)));
        for_each_law(AllLaws{}, Family::strength, [&](const auto& law) {
          if constexpr (Yielding<std::remove_cvref_t<decltype(law)>>) {
            const StartState<double> start{T.v[i], 1e3 * e.v[i], rho.v[i] / 8960.0};
            const StartState<Pack> start8{T.pack(), 1e3 * e.pack(), rho.pack() / 8960.0};
            const auto one = update_deviator(law, stress(lane), dtL, dE, eps.v[i], start, G, dt);
            const auto eight =
                update_deviator(law, stress(wide), matrix(wide), dE8, eps.pack(), start8, G, dt);
            REQUIRE(same(one.step.d, get(eight.step.d, i)));
            REQUIRE(same(one.s.xx, get(eight.s.xx, i)));
            REQUIRE(same(one.s.yz, get(eight.s.yz, i)));
          }
        });
        for_each_law(AllLaws{}, Family::damage, [&](const auto& law) {
          if constexpr (std::remove_cvref_t<decltype(law)>::family == Family::damage) {
            const auto driver = [&](auto get, auto real) {
              using Real = decltype(real);
              const Sym3<Real> d = stress(get);
              return DamageDriver<Real>{
                  d,       equivalent_stress(d), d.yz,   d.xz * 1e-8, Real(139e9),
                  Real(G), 1e7 * get(eps),       get(T), dt};
            };
            const auto one = law.growth(driver(lane, 0.0));
            const auto eight = law.growth(driver(wide, Pack(0.0)));
            REQUIRE(same(one.k, get(eight.k, i)));
            REQUIRE(same(one.source, get(eight.source, i)));
            REQUIRE(same(one.eps_D, get(eight.eps_D, i)));
            const auto curve = make_law<VonMises>(std::vector{9e7, 3e8}.data(), kCopper).at(0.0);
            const Growth<double> growth{one.k, one.eps_D, one.phi_c};
            const Growth<Pack> growth8{eight.k, eight.eps_D, eight.phi_c};
            const auto r1 = rate_return(curve, equivalent_stress(stress(lane)), eps.v[i], G, 0.1,
                                        growth, 1e-3, dt);
            const auto curve8 =
                make_law<VonMises>(std::vector{9e7, 3e8}.data(), kCopper).at(Pack(0.0));
            const auto r8 = rate_return(curve8, equivalent_stress(stress(wide)), eps.pack(), G,
                                        Pack(0.1), growth8, Pack(1e-3), dt);
            REQUIRE(same(r1.step.d, get(r8.step.d, i)));
          }
        });
        const auto turn = [&](auto rate) {
          using RateForm = decltype(rate);
          const auto f1 = plus_identity(dtL);
          const auto f8 = plus_identity(matrix(wide));
          REQUIRE(same(RateForm::trial(stress(lane), {dtL, dE, f1}, G).xy,
                       get(RateForm::trial(stress(wide), {matrix(wide), dE8, f8}, G).xy, i)));
        };
        turn(TruesdellProjectedRate{});
        turn(JaumannRate{});
        turn(GreenNaghdiRate{});
        for_each_law(AllLaws{}, Family::eos, [&](const auto& eos) {
          if constexpr (requires { eos.c0; } && !OwnsState<std::remove_cvref_t<decltype(eos)>>) {
            const auto one = advance_energy(eos, rho.v[i], 1.0 / rho.v[i], 1e9, e.v[i], 1e-7, 10.0);
            const auto eight = advance_energy(eos, rho.pack(), 1.0 / rho.pack(), Pack(1e9),
                                              e.pack(), Pack(1e-7), Pack(10.0));
            REQUIRE(
                same(eos.bulk_modulus(rho.v[i], 1.0 / rho.v[i], 1e9, e.v[i]),
                     get(eos.bulk_modulus(rho.pack(), 1.0 / rho.pack(), Pack(1e9), e.pack()), i)));
            REQUIRE(same(one.pressure, get(eight.pressure, i)));
            REQUIRE(same(one.energy, get(eight.energy, i)));
          }
        });
        REQUIRE(same(signal_speed(4000.0, G, 1.0 / rho.v[i], 1e6 * (i - 4), 0.3, 2.0, 1e-4),
                     get(signal_speed(Pack(4000.0), Pack(G), 1.0 / rho.pack(), Pack(1e6 * (i - 4)),
                                      0.3, 2.0, Pack(1e-4)),
                         i)));
      }
    }
  }
}
