// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/materials/returns/trial_deviator.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "krater/materials/stages/kinematics_stage.hpp"
#include "krater/materials/stages/strength_stage.hpp"

namespace {

using namespace krater;
using S = Sym3<double>;
using M = Mat3<double>;

constexpr double G = 46e9;

double largest(const S& a) {
  double m = 0.0;
  for (const double c : {a.xx, a.yy, a.zz, a.yz, a.xz, a.xy}) m = std::max(m, std::fabs(c));
  return m;
}
S minus(const S& a, const S& b) { return a + (-1.0) * b; }

M minus_identity(M f) {
  f.xx -= 1.0;
  f.yy -= 1.0;
  f.zz -= 1.0;
  return f;
}

/// Rotation by `angle` about axis 0, 1, 2 or, for 3, the space diagonal (Rodrigues).
M rotation(int axis, double angle) {
  double n[3] = {axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
  if (axis == 3) n[0] = n[1] = n[2] = 1.0 / std::sqrt(3.0);
  const double c = std::cos(angle), s = std::sin(angle), k = 1.0 - c;
  return {c + k * n[0] * n[0],        k * n[0] * n[1] - s * n[2], k * n[0] * n[2] + s * n[1],
          k * n[0] * n[1] + s * n[2], c + k * n[1] * n[1],        k * n[1] * n[2] - s * n[0],
          k * n[0] * n[2] - s * n[1], k * n[1] * n[2] + s * n[0], c + k * n[2] * n[2]};
}

/// A reachable elastic deviator: any b with det b = 1 gives one.
S random_deviator(std::mt19937& random, double size) {
  std::normal_distribution<double> normal{0.0, size};
  M f = identity3<double>();
  for (double* c : {&f.xx, &f.xy, &f.xz, &f.yx, &f.yy, &f.yz, &f.zx, &f.zy, &f.zz})
    *c += normal(random);
  const double r = std::cbrt(1.0 / std::fabs(det(f)));
  return (G * r * r) * dev(product_transposed(f, f));
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE(
      "trial deviator: a body at rest keeps every bit, also under pure compression and spin") {
    std::mt19937 random{1};
    const S s = random_deviator(random, 0.01);
    const M rest = 0.0 * identity3<double>();
    CHECK(largest(minus(trial_deviator(s, rest, G), s)) == 0.0);
    for (const double stretch : {0.5, 0.999, 1.0, 1.0 + 1e-9, 2.0}) {
      const S t = trial_deviator(zero_sym3<double>(), (stretch - 1.0) * identity3<double>(), G);
      CHECK(largest(t) == 0.0);
    }
    const S spun = trial_deviator(zero_sym3<double>(), minus_identity(rotation(3, 0.3)), G);
    CHECK(largest(spun) < 1e-15 * G);
  }

  TEST_CASE("trial deviator: the isotropic part is the largest root for any deviator") {
    std::mt19937 random{2};
    std::normal_distribution<double> normal;
    for (int i = 0; i < 20000; ++i) {
      const double size = std::pow(10.0, std::uniform_real_distribution<double>{-8.0, 1.5}(random));
      const S X = size * dev(S{normal(random), normal(random), normal(random), normal(random),
                               normal(random), normal(random)});
      const double a = isotropic_part(X);
      const S b{X.xx + a, X.yy + a, X.zz + a, X.yz, X.xz, X.xy};
      const double slope = 3.0 * a * a - 0.5 * contract(X, X);
      REQUIRE(a >= 1.0);
      // det b = 1 to the round-off of its terms, and b positive definite (the largest root).
      REQUIRE(std::fabs(det(b) - 1.0) < 1e-13 * (1.0 + a * a * a) + 1e-13 * slope);
      REQUIRE(b.xx + b.yy + b.zz > 0.0);
      REQUIRE(b.xx * b.yy - b.xy * b.xy + b.xx * b.zz - b.xz * b.xz + b.yy * b.zz - b.yz * b.yz >
              0.0);
    }
  }

  TEST_CASE("trial deviator: objective for f = R U about every axis, 1e-12") {
    std::mt19937 random{3};
    for (const double angle : {0.1, 1.0, 3.0}) {
      for (int axis = 0; axis < 4; ++axis) {
        const S s = random_deviator(random, 0.1);
        M U = identity3<double>();
        U.xx += 0.006;
        U.yy -= 0.004;
        U.xy = U.yx = 0.005;
        U.yz = U.zy = -0.003;
        const M R = rotation(axis, angle);
        const S whole = trial_deviator(s, minus_identity(R * U), G);
        const S turned = push_forward(R, trial_deviator(s, minus_identity(U), G));
        CHECK(largest(minus(whole, turned)) < 1e-12 * G);
      }
    }
  }

  TEST_CASE("trial deviator: simple shear, theory 13, in one step and in a thousand") {
    for (const double gamma : {0.01, 0.5, 2.0, 8.0}) {
      for (const int steps : {1, 7, 1000}) {
        S s = zero_sym3<double>();
        M dtL = 0.0 * identity3<double>();
        dtL.xy = gamma / steps;
        for (int i = 0; i < steps; ++i) s = trial_deviator(s, dtL, G);
        const double tolerance = 2e-12 * G * (1.0 + gamma * gamma);
        CHECK(std::fabs(s.xy - G * gamma) < tolerance);
        CHECK(std::fabs(s.xx - G * 2.0 * gamma * gamma / 3.0) < tolerance);
        CHECK(std::fabs(s.yy + G * gamma * gamma / 3.0) < tolerance);
        CHECK(std::fabs(s.zz + G * gamma * gamma / 3.0) < tolerance);
        CHECK(std::fabs(s.yz) + std::fabs(s.xz) == 0.0);
      }
    }
  }

  TEST_CASE("trial deviator: uniaxial stretch, theory 13; a frozen deviator under compression") {
    for (const double stretch : {0.3, 0.9, 1.001, 1.5, 4.0}) {
      for (const int steps : {1, 300}) {
        S s = zero_sym3<double>();
        M dtL = 0.0 * identity3<double>();
        dtL.zz = std::pow(stretch, 1.0 / steps) - 1.0;
        for (int i = 0; i < steps; ++i) s = trial_deviator(s, dtL, G);
        const double exact =
            2.0 / 3.0 * (std::pow(stretch, 4.0 / 3.0) - std::pow(stretch, -2.0 / 3.0));
        CHECK(std::fabs(s.zz - G * exact) < 1e-11 * G * (1.0 + std::fabs(exact)));
        CHECK(std::fabs(s.xx + 0.5 * G * exact) < 1e-11 * G * (1.0 + std::fabs(exact)));
      }
    }
    std::mt19937 random{4};
    const S s = random_deviator(random, 0.05);
    const S squeezed = trial_deviator(s, -0.2 * identity3<double>(), G);
    CHECK(largest(minus(squeezed, s)) < 1e-14 * G);
  }

  TEST_CASE("trial deviator: no elastic hysteresis in a closed path of finite strain") {
    // f4 f3 f2 f1 = I exactly: shear, stretch and back in another order.
    std::mt19937 random{5};
    const S start = random_deviator(random, 0.05);
    const M f1 = {1.0, 0.7, 0.0, 0.0, 1.0, 0.0, 0.0, 0.3, 1.0};
    const M f2 = {1.2, 0.0, 0.1, 0.0, 0.8, 0.0, 0.0, 0.0, 1.1};
    const M f3 = inverse(f2 * f1);
    S s = start;
    for (const M& f : {f1, f2, f3}) s = trial_deviator(s, minus_identity(f), G);
    CHECK(largest(minus(s, start)) < 2e-14 * G);
  }

  TEST_CASE(
      "deviatoric work: a closed elastic cycle returns its energy, with second order in the step") {
    double error[2];
    for (int level = 0; level < 2; ++level) {
      const int steps = 40 << level;
      S s = zero_sym3<double>();
      double work = 0.0, peak = 0.0;
      M F = identity3<double>();
      for (int i = 0; i < steps; ++i) {
        const auto path = [&](double t) {  // closed loop in shear and stretch
          const double a = 0.05 * std::sin(2.0 * M_PI * t),
                       b = 0.04 * (1.0 - std::cos(2.0 * M_PI * t));
          return M{1.0 + a, b, 0.0, 0.0, 1.0 / (1.0 + a), 0.5 * a, 0.0, 0.0, 1.0};
        };
        const M next = path((i + 1.0) / steps);
        const M dtL = minus_identity(next * inverse(F));
        const S t = trial_deviator(s, dtL, G);
        work += deviatoric_work(s, t, strain_step(dtL), 1.0, 1.0);
        peak = std::max(peak, work);
        s = t;
        F = next;
      }
      error[level] = std::fabs(work) / peak;
      CHECK(largest(s) < 1e-12 * G);
    }
    CHECK(error[0] < 1e-2);
    CHECK(error[0] / error[1] > 3.5);
  }
}
