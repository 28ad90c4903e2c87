// SPDX-License-Identifier: GPL-3.0-or-later
// The objective rates other than truesdell (trial_deviator_test.cpp) against their closed forms:
// theory 13, theory D9.
#include "krater/materials/returns/rates.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "krater/materials/stages/kinematics_stage.hpp"

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

template <class RateForm>
S advance(const S& s, const M& f, M& F) {
  const M dtL = minus_identity(f);
  F = f * F;
  return RateForm::trial(s, {dtL, strain_step(dtL), F}, G);
}

/// Simple shear to gamma in n steps, per G.
template <class RateForm>
S shear(double gamma, int n) {
  S s = zero_sym3<double>();
  M F = identity3<double>(), f = F;
  f.xy = gamma / n;
  for (int i = 0; i < n; ++i) s = advance<RateForm>(s, f, F);
  return (1.0 / G) * s;
}

struct Exact {
  double s12, s11, s22;
};
Exact exact(JaumannRate, double g) { return {std::sin(g), 1.0 - std::cos(g), std::cos(g) - 1.0}; }
Exact exact(TruesdellRate, double g) { return {g, 2.0 * g * g / 3.0, -g * g / 3.0}; }
Exact exact(TruesdellProjectedRate, double g) {
  const double k = std::sqrt(2.0 / 3.0), s11 = 2.0 * (1.0 - std::cos(k * g));
  return {std::sqrt(1.5) * std::sin(k * g), s11, -0.5 * s11};
}
Exact exact(GreenNaghdiRate, double g) {
  const double b = std::atan(0.5 * g), l = std::log(std::cos(b));
  const double s11 =
      4.0 * (std::cos(2.0 * b) * l + b * std::sin(2.0 * b) - std::sin(b) * std::sin(b));
  return {2.0 * (std::cos(2.0 * b) * (2.0 * b - std::tan(b)) - 2.0 * std::sin(2.0 * b) * l), s11,
          -s11};
}

double error(const S& s, const Exact& e) {
  return std::max({std::fabs(s.xy - e.s12), std::fabs(s.xx - e.s11), std::fabs(s.yy - e.s22),
                   std::fabs(s.yz) + std::fabs(s.xz)});
}

/// The closed form at every gamma of the table, 1000 and 2000 steps per unit of gamma: the error
/// and its order, and what is left after extrapolation.
template <class RateForm>
void check_shear(double expected_order, double tolerance) {
  for (const double gamma : {0.5, 1.0, 2.0, 4.0, 8.0}) {
    CAPTURE(gamma);
    const int n = static_cast<int>(1000 * gamma);
    const S coarse = shear<RateForm>(gamma, n), fine = shear<RateForm>(gamma, 2 * n);
    const Exact e = exact(RateForm{}, gamma);
    const double order = std::log2(error(coarse, e) / error(fine, e));
    CHECK(error(fine, e) < tolerance);
    CHECK(std::fabs(order - expected_order) < 0.1);
    const double k = std::exp2(expected_order);
    CHECK(error((1.0 / (k - 1.0)) * (k * fine + (-1.0) * coarse), e) < 1e-5);
  }
}

M turned(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0};
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("rates: simple shear to gamma 8 converges to the closed forms, each at its order") {
    SUBCASE("truesdell_projected") { check_shear<TruesdellProjectedRate>(1.0, 5e-3); }
    SUBCASE("jaumann") { check_shear<JaumannRate>(1.0, 1e-3); }
    SUBCASE("green_naghdi") { check_shear<GreenNaghdiRate>(2.0, 1e-7); }
    for (const double gamma : {0.5, 1.0, 2.0, 4.0, 8.0})
      CHECK(error(shear<TruesdellRate>(gamma, 1), exact(TruesdellRate{}, gamma)) <
            2e-12 * (1.0 + gamma * gamma));
  }

  TEST_CASE("rates: the closed forms here are the numbers of theory 13 and theory D9") {
    const double g[] = {0.5, 1.0, 2.0, 4.0, 8.0};
    const double j12[] = {.479426, .841471, .909297, -.756802, .989358},
                 j11[] = {.122417, .459698, 1.416147, 1.653644, 1.145500},
                 n12[] = {.480513, .869784, 1.386294, 2.317944, 5.046021},
                 n11[] = {.118858, .415900, 1.141593, 2.274201, 3.730739},
                 p12[] = {.486226, .892534, 1.222377, -.151958, .301567},
                 p11[] = {.164365, .630443, 2.124313, 3.984546, .061577};
    for (int i = 0; i < 5; ++i) {
      CHECK(std::fabs(exact(JaumannRate{}, g[i]).s12 - j12[i]) < 6e-7);
      CHECK(std::fabs(exact(JaumannRate{}, g[i]).s11 - j11[i]) < 6e-7);
      CHECK(std::fabs(exact(GreenNaghdiRate{}, g[i]).s12 - n12[i]) < 6e-7);
      CHECK(std::fabs(exact(GreenNaghdiRate{}, g[i]).s11 - n11[i]) < 6e-7);
      CHECK(std::fabs(exact(TruesdellProjectedRate{}, g[i]).s12 - p12[i]) < 6e-7);
      CHECK(std::fabs(exact(TruesdellProjectedRate{}, g[i]).s11 - p11[i]) < 6e-7);
    }
  }

  TEST_CASE("rates: uniaxial stretch, theory 13") {
    const int n = 20000;
    for (const double stretch : {0.5, 1.5, 3.0}) {
      const auto stretched = [&](auto rate) {
        S s = zero_sym3<double>();
        M F = identity3<double>(), f = F;
        f.xx = std::pow(stretch, 1.0 / n);
        for (int i = 0; i < n; ++i) s = advance<decltype(rate)>(s, f, F);
        return s.xx / G;
      };
      CHECK(stretched(TruesdellProjectedRate{}) ==
            doctest::Approx(4.0 * (std::cbrt(stretch) - 1.0)).epsilon(1e-4));
      CHECK(stretched(JaumannRate{}) ==
            doctest::Approx(4.0 / 3.0 * std::log(stretch)).epsilon(1e-6));
      CHECK(stretched(GreenNaghdiRate{}) ==
            doctest::Approx(4.0 / 3.0 * std::log(stretch)).epsilon(1e-6));
    }
  }

  TEST_CASE("rates: a body at rest keeps every bit; a spinning one its turned stress") {
    const S s = {3e8, -1e8, -2e8, 4e7, -5e7, 6e7};
    const auto check = [&](auto rate, double spin_error) {
      M F = identity3<double>();
      CHECK(largest(minus(advance<decltype(rate)>(s, identity3<double>(), F), s)) == 0.0);
      const M R = turned(0.3);
      const S t = advance<decltype(rate)>(s, R, F);
      CHECK(largest(minus(t, push_forward(R, s))) <= spin_error * 3e8);
    };
    check(TruesdellProjectedRate{}, 1e-14);
    check(GreenNaghdiRate{}, 1e-14);
    check(JaumannRate{}, 1e-14);  // W of a finite turn by tan(angle/2): Q is the turn itself
  }

  TEST_CASE("rates: objective for f = R U to first order in the angle, green_naghdi to second") {
    const S s = {3e8, -1e8, -2e8, 4e7, -5e7, 6e7};
    M U = identity3<double>();
    U.xx += 0.006, U.yy -= 0.004, U.xy = U.yx = 0.005;
    const auto fault = [&](auto rate, double angle) {
      M F = identity3<double>(), F0 = F;
      const S still = advance<decltype(rate)>(s, U, F0);
      const M R = turned(angle);
      return largest(minus(advance<decltype(rate)>(s, R * U, F), push_forward(R, still))) / G;
    };
    CHECK(fault(TruesdellRate{}, 3.0) < 1e-12);
    for (const double angle : {0.1, 0.01}) {
      CHECK(fault(TruesdellProjectedRate{}, angle) < 0.05 * angle);
      CHECK(fault(JaumannRate{}, angle) < 0.05 * angle);
      CHECK(fault(GreenNaghdiRate{}, angle) < 0.01 * angle * angle);
    }
  }

  TEST_CASE("polar rotation: R of R U for large stretches and turns") {
    for (const double angle : {0.0, 0.5, 3.1}) {
      for (const double stretch : {1.0, 0.1, 8.0, 300.0}) {
        M U = identity3<double>();
        U.xx = stretch, U.yy = 1.0 / stretch, U.yz = U.zy = 0.1 / stretch;
        const M R = polar_rotation(turned(angle) * U), e = turned(angle);
        CHECK(std::fabs(R.xx - e.xx) < 1e-12);
        CHECK(std::fabs(R.xy - e.xy) < 1e-12);
        CHECK(std::fabs(R.yx - e.yx) < 1e-12);
        CHECK(std::fabs(R.zz - 1.0) < 1e-12);
      }
    }
  }
}
