// SPDX-License-Identifier: GPL-3.0-or-later
// States behind a shock from the equation of state itself, and the energy update along its path.
#include "krater/materials/scalar_eos.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "hugoniot_rows.hpp"
#include "krater/core/errors.hpp"
#include "krater/materials/catalogue.hpp"
#include "krater/materials/eos/mie_gruneisen_shock.hpp"
#include "krater/materials/stages/eos_stage.hpp"

namespace {

using namespace krater;
using doctest::Approx;

std::unique_ptr<ScalarEos> make(const char* name, std::vector<double> values, double rho0) {
  return make_scalar_eos(find_law("eos", name), values.data(), {rho0, 0.0, 294.0});
}

/// The three jump conditions, from the state alone.
void check_jump(const ScalarEos& eos, const ShockState& s) {
  CHECK(s.density * (s.shock_speed - s.particle_speed) ==
        Approx(eos.rho0 * s.shock_speed).epsilon(1e-10));
  CHECK(s.pressure - eos.p0 == Approx(eos.rho0 * s.shock_speed * s.particle_speed).epsilon(1e-10));
  const double dv = 1 / eos.rho0 - 1 / s.density;
  const double gain = 0.5 * (s.pressure + eos.p0) * dv;  // small beside e0 of a stiffened gas
  CHECK(std::fabs(s.energy - eos.e0 - gain) <= 1e-10 * gain + 4e-16 * eos.e0);
  CHECK(eos.pressure(s.density, s.energy) == Approx(s.pressure).epsilon(1e-13));
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("behind a shock: every row of hugoniot.csv, and back from the density") {
    for (const test::HugoniotRow& row : test::kHugoniot) {
      CAPTURE(std::string{row.material});
      CAPTURE(row.up);
      const auto eos = make("mie_gruneisen_shock", {row.c0, row.S1, row.gamma0}, row.rho0);
      const ShockState s = behind_shock(*eos, row.up);
      CHECK(s.shock_speed == Approx(row.c0 + row.S1 * row.up).epsilon(1e-12));
      CHECK(s.density / row.rho0 == Approx(row.compression).epsilon(1e-6));
      CHECK(s.pressure == Approx(row.pressure).epsilon(5e-6));  // printed with six digits
      CHECK(s.energy == Approx(0.5 * row.up * row.up).epsilon(1e-14));
      CHECK(shocked_to_density(*eos, s.density).particle_speed == Approx(row.up).epsilon(1e-10));
      CHECK_FALSE(eos->beyond_pole(s.density));
      check_jump(*eos, s);
    }
  }

  TEST_CASE("behind a shock: every law satisfies the jump conditions, weak and strong") {
    const struct {
      const char* name;
      std::vector<double> values;
      double rho0;
    } laws[] = {{"linear", {139e9}, 8960},
                {"mie_gruneisen_polynomial", {163.9e9, 294.4e9, 500e9, 1.16}, 7823},
                {"mie_gruneisen_shock", {3940, 1.489, 2.02}, 8930},
                {"ideal_gas", {1.4, 1e5}, 1.2},
                {"stiffened_gas", {3.8, 20.805e9, 0}, 2785},
                {"jwl", {371.2e9, 3.231e9, 4.15, 0.95, 0.30, 7.0e9}, 1630},
                {"tillotson", {0.5, 1.63, 75.2e9, 65e9, 5e6, 3e6, 13.9e6, 5, 5}, 2700}};
    for (const auto& law : laws) {
      CAPTURE(std::string{law.name});
      const auto eos = make(law.name, law.values, law.rho0);
      const ShockState rest = behind_shock(*eos, 0);
      CHECK(rest.density == law.rho0);
      CHECK(rest.shock_speed == eos->c0);
      CHECK(rest.sound_speed == Approx(eos->c0).epsilon(1e-12));
      for (const double mach : {1e-4, 0.01, 0.3, 1.0}) {
        const ShockState s = behind_shock(*eos, mach * eos->c0);
        CAPTURE(mach);
        check_jump(*eos, s);
        CHECK(s.shock_speed >= eos->c0 * (1 - 1e-9));  // a shock outruns the sound ahead of it ...
        if (std::string{law.name} != "linear")         // ... and is caught up by that behind it
          CHECK(s.shock_speed - s.particle_speed <= s.sound_speed * (1 + 1e-9));
        CHECK(shocked_to_density(*eos, s.density).particle_speed ==
              Approx(s.particle_speed).epsilon(1e-7));
      }
    }
  }

  TEST_CASE("behind a shock: stiffened gas of theory D4, cubic Hugoniots of theory D1") {
    // p_inf is printed there with five digits.
    const auto al = make("stiffened_gas", {3.8, 20.805e9, 1e5}, 2785);
    CHECK(behind_shock(*al, 50).pressure == Approx(0.75043e9).epsilon(1e-5));
    CHECK(behind_shock(*al, 500).pressure == Approx(8.30175e9).epsilon(1e-5));
    CHECK(behind_shock(*al, 500).density == Approx(3039.96).epsilon(2e-6));
    const auto steel = make("mie_gruneisen_polynomial", {163.9e9, 294.4e9, 500e9, 1.16}, 7823);
    const auto alu = make("mie_gruneisen_polynomial", {76.74e9, 128.3e9, 125.1e9, 2.0}, 2768);
    const double up[] = {250, 500, 1000, 3000}, in_steel[] = {9.656, 20.774, 47.535, 212.97},
                 in_al[] = {3.877, 8.227, 18.363, 77.768};
    for (int i = 0; i < 4; ++i) {
      CHECK(behind_shock(*steel, up[i]).pressure == Approx(1e9 * in_steel[i]).epsilon(6e-5));
      CHECK(behind_shock(*alu, up[i]).pressure == Approx(1e9 * in_al[i]).epsilon(6e-5));
    }
  }

  TEST_CASE("behind a shock: what no single shock can do is said") {
    const auto gas = make("ideal_gas", {1.4, 1e5}, 1.2);
    CHECK(behind_shock(*gas, 1e6).density == Approx(7.2).epsilon(1e-4));  // (g+1)/(g-1) at most
    CHECK_THROWS_AS(shocked_to_density(*gas, 7.3), InputError);
    CHECK_THROWS_AS(shocked_to_density(*gas, 1.1), InputError);
  }

  TEST_CASE("Algorithm 1: exact along a Rayleigh line, second order along another shock path") {
    const double values[] = {3940.0, 1.489, 2.02};
    const auto law = make_law<MieGruneisenShock>(values, {8930.0, 0.0, 294.0});
    const auto eos = make("mie_gruneisen_shock", {3940.0, 1.489, 2.02}, 8930.0);
    const ShockState behind = behind_shock(*eos, 1000);
    const double v0 = 1 / eos->rho0, v1 = 1 / behind.density;
    const auto line = [&](double v) { return behind.pressure * (v0 - v) / (v0 - v1); };
    const auto march = [&](int steps, const auto& viscosity) {
      double p = 0.0, e = 0.0, v = v0;
      for (int i = 1; i <= steps; ++i) {
        const double next = v0 + (v1 - v0) * i / steps, dv = next - v;
        const double work = -0.5 * (viscosity(v) + viscosity(next)) * dv;
        const auto closed = close_energy(law.split(1 / next, next), p, e, dv, work);
        p = closed.pressure, e = closed.energy, v = next;
      }
      return e;
    };
    // The steady shock: p + q on the line, so e is half the area below it, whatever the steps.
    const auto steady = [&](double v) {
      return line(v) - eos->pressure(1 / v, 0.5 * line(v) * (v0 - v));
    };
    for (const int steps : {1, 3, 50})
      CHECK(march(steps, steady) == Approx(behind.energy).epsilon(1e-12));
    // A path with more dissipation than the steady one has no closed form: Runge-Kutta.
    const auto rough = [&](double v) {
      return 3 * steady(v) + 0.1 * line(v) * line(v) / behind.pressure;
    };
    double e = 0.0;
    constexpr int fine = 4000;
    for (int i = 0; i < fine; ++i) {
      const double dv = (v1 - v0) / fine, v = v0 + i * dv;
      const auto slope = [&](double at, double energy) {
        return -eos->pressure(1 / at, energy) - rough(at);
      };
      const double k1 = slope(v, e), k2 = slope(v + 0.5 * dv, e + 0.5 * dv * k1);
      const double k3 = slope(v + 0.5 * dv, e + 0.5 * dv * k2), k4 = slope(v + dv, e + dv * k3);
      e += dv * (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0;
    }
    const double coarse = std::fabs(march(20, rough) - e), finer = std::fabs(march(40, rough) - e);
    CHECK(coarse < 1e-2 * e);
    CHECK(coarse / finer == Approx(4.0).epsilon(0.1));
  }
}
