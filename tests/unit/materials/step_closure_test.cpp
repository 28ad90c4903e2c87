// SPDX-License-Identifier: GPL-3.0-or-later
// The small closed forms around the laws: strain of a step, volume, viscosity, heating, signal
// speed.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "krater/materials/eos/mie_gruneisen_shock.hpp"
#include "krater/materials/heating/plastic_work.hpp"
#include "krater/materials/stages/eos_stage.hpp"
#include "krater/materials/stages/heating_stage.hpp"
#include "krater/materials/stages/kinematics_stage.hpp"
#include "krater/materials/stages/signal_speed_stage.hpp"
#include "krater/materials/viscosity/bulk_viscosity.hpp"

namespace {

using namespace krater;

Mat3<double> minus_identity(Mat3<double> f) {
  f.xx -= 1.0;
  f.yy -= 1.0;
  f.zz -= 1.0;
  return f;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("kinematics: a rotation strains nothing; sym(dt L) would (theory 3)") {
    for (const double angle : {1e-3, 0.5, 2.0}) {
      const double c = std::cos(angle), s = std::sin(angle);
      const Mat3<double> turn = minus_identity({c, 0.0, s, 0.0, 1.0, 0.0, -s, 0.0, c});
      const Sym3<double> dE = strain_step(turn);
      for (const double e : {dE.xx, dE.yy, dE.zz, dE.yz, dE.xz, dE.xy}) CHECK(std::fabs(e) < 1e-15);
      CHECK(volume_step(turn, 0.0).j == doctest::Approx(1.0).epsilon(1e-15));
    }
    // Second order in the step for a stretch: H = 2 (l - 1)/(l + 1), ln l to third order.
    const Mat3<double> stretch{0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    CHECK(strain_step(stretch).xx == doctest::Approx(0.2 / 2.1).epsilon(1e-14));
  }

  TEST_CASE("kinematics: volume ratio, also averaged and at tiny strain") {
    const Mat3<double> a{0.1, 0.3, -0.2, 0.05, -0.1, 0.4, 0.2, 0.1, 0.15};
    Mat3<double> f = a;
    f.xx += 1.0;
    f.yy += 1.0;
    f.zz += 1.0;
    CHECK(volume_step(a, 0.0).j == doctest::Approx(det(f)).epsilon(1e-15));
    CHECK(volume_step(a, 0.02).j_bar == doctest::Approx(det(f) * 1.01 / 0.99).epsilon(1e-15));
    const Mat3<double> tiny = 1e-13 * a;
    CHECK(det_minus_one(tiny) == doctest::Approx(1e-13 * 0.15).epsilon(1e-12));
    const Mat3<double> product = inverse(f) * f;
    CHECK(product.xx == doctest::Approx(1.0).epsilon(1e-14));
    CHECK(std::fabs(product.xy) + std::fabs(product.yz) + std::fabs(product.zx) < 1e-15);
    const Mat3<double> F = advance_deformation(a, f), exact = f * f;
    CHECK(F.xz == doctest::Approx(exact.xz).epsilon(1e-14));
    CHECK(F.zz == doctest::Approx(exact.zz).epsilon(1e-14));
  }

  TEST_CASE("viscosity: Decision 7 in compression, nothing in expansion") {
    const double values[] = {0.3, 2.0};
    const auto law = make_law<BulkViscosity>(values, {8960.0, 0.0, 294.0});
    const double rho = 9000.0, c = 4000.0, h = 1e-3, rate = -2e5;
    CHECK(law(rho, c, rate, h) ==
          doctest::Approx(rho * h * (2.0 * h * rate * rate - 0.3 * c * rate)).epsilon(1e-14));
    CHECK(law(rho, c, rate, h) > 0.0);
    CHECK(law(rho, c, 2e5, h) == 0.0);
    CHECK(law(rho, c, 0.0, h) == 0.0);
  }

  TEST_CASE("heating: Taylor-Quinney") {
    const double values[] = {0.9, 383.0};
    const auto law = make_law<PlasticWorkHeating>(values, {8960.0, 0.0, 294.0});
    CHECK(law(1000.0) == doctest::Approx(0.9 * 1000.0 / 383.0).epsilon(1e-15));
  }

  TEST_CASE("signal speed: theory 12") {
    const double rho = 8960.0, c = 3940.0, G = 46e9, h = 1e-3;
    const double c_L = std::sqrt(c * c + 4.0 * G / (3.0 * rho));
    const double edge = std::sqrt(c_L * c_L + c * c), fluid_edge = std::sqrt(2.0) * c;
    CHECK(signal_speed(c, G, 1.0 / rho, 1e6, 0.3, 2.0, h) == doctest::Approx(edge).epsilon(1e-14));
    CHECK(signal_speed(c, 0.0, 1.0 / rho, 0.0, 0.3, 2.0, h) ==
          doctest::Approx(fluid_edge).epsilon(1e-14));
    const double Qv = 0.3 * c + 2.0 * 2.0 * h * 1e6;
    CHECK(signal_speed(c, G, 1.0 / rho, -1e6, 0.3, 2.0, h) ==
          doctest::Approx(Qv + std::sqrt(Qv * Qv + c_L * c_L)).epsilon(1e-14));
  }

  TEST_CASE("energy closure, carried: p~ is that of the new energy, p^ = w p~ cut off, p^ works") {
    const double values[] = {3940.0, 1.489, 2.02};
    const auto law = make_law<MieGruneisenShock>(values, {8960.0, 46e9, 294.0});
    for (const double x : {0.8, 0.97, 1.02, 1.3}) {
      const double rho = 8960.0 * x, v = 1.0 / rho, dv = (x < 1.0 ? 0.1 : -0.1) * v;
      const auto split = law.split(rho, v);
      for (const double loss : {0.0, 0.4, 0.999, 1.0}) {
        for (const double spall : {1e300, 1e9}) {
          const double p = -1e9, e = 2e5, work = 3e3;
          const auto all = close_carried(split, p, e, dv, work, loss, 0.5 * loss, spall);
          const double w = 1.0 - (all.effective < 0.0 ? loss : 0.5 * loss);
          CHECK(all.spalled == (w * all.effective < -spall));
          CHECK(all.step.pressure == std::max(w * all.effective, -spall));
          CHECK(all.step.energy ==
                doctest::Approx(e + work - 0.5 * dv * (p + all.step.pressure)).epsilon(1e-13));
          if (all.spalled) continue;
          CHECK(all.effective ==
                doctest::Approx(split.cold + split.thermal * all.step.energy).epsilon(1e-12));
        }
      }
    }
  }
}
