// SPDX-License-Identifier: GPL-3.0-or-later
// exp, log, pow, rcbrt: error against long double, edges, and equal bits for Pack and double at
// every batch position.
#include "krater/core/lane_math.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

using krater::Pack;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double edges[] = {0.0,
                            -0.0,
                            1.0,
                            -1.0,
                            0.5,
                            2.0,
                            3.0,
                            -2.5,
                            inf,
                            -inf,
                            not_a_number,
                            5e-324,
                            1e-310,
                            0x1p-1022,
                            0x1.fffffffffffffp1023,
                            -1e308,
                            709.78,
                            709.79,
                            -708.4,
                            -745.1,
                            -745.2,
                            1e5,
                            -1e5,
                            0x1.fffffffffffffp-1,
                            0x1.0000000000001p0,
                            0.75,
                            1.5,
                            0x1.7ffffffffffffp0};

constexpr int edge_count = sizeof(edges) / sizeof(edges[0]);

/// |got - exact| in units of the last place of the exact value (of the denormal spacing below
/// 2^-1022).
double error_in_ulp(double got, long double exact) {
  int exponent = 0;
  std::frexp(exact, &exponent);
  if (exponent < -1021) exponent = -1021;
  return static_cast<double>(std::fabs(static_cast<long double>(got) - exact) /
                             std::ldexp(1.0L, exponent - 53));
}

bool same(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
  return std::memcmp(&a, &b, sizeof a) == 0;
}

class Random {
 public:
  double uniform(double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(generator_);
  }
  /// Spread evenly in the exponent.
  double logarithmic(double lo, double hi) { return std::exp(uniform(std::log(lo), std::log(hi))); }

 private:
  std::mt19937_64 generator_{20240229};
};

/// Largest error over `trials` draws; `draw` returns the argument(s), `error` the error there.
template <class Draw, class Error>
double worst(Draw draw, Error error) {
  Random random;
  double largest = 0.0;
  for (int i = 0; i < 200000; ++i) {
    const double e = error(draw(random));
    if (!(e <= largest)) largest = e;
  }
  return largest;
}

/// Lanes in which the function of a batch and of a double differ, each value visiting all eight
/// positions.
template <class Function, class Draw>
int disagreements(Function function, Draw draw) {
  Random random;
  int wrong = 0;
  alignas(64) double x[16];
  alignas(64) double y[16];
  for (int trial = 0; trial < 15000; ++trial) {
    for (int i = 0; i < 8; ++i) {
      x[i] = x[i + 8] = draw(random);
      y[i] = y[i + 8] = random.uniform(-3.0, 3.0);
    }
    if (trial % 8 == 0) {
      x[3] = x[11] = edges[(trial / 8) % edge_count];
      y[3] = y[11] = edges[(trial / 8 / edge_count) % edge_count];
    }
    const int shift = trial % 8;
    const Pack result = function(krater::loadu(x + shift), krater::loadu(y + shift));
    for (int i = 0; i < 8; ++i)
      if (!same(krater::get(result, i), function(x[shift + i], y[shift + i]))) ++wrong;
  }
  return wrong;
}

}  // namespace

TEST_CASE("Pack and double give the same bits") {
  const auto any_double = [](Random& r) { return r.logarithmic(1e-300, 1e300); };
  CHECK(disagreements([](auto x, auto) { return krater::exp(x); },
                      [](Random& r) { return r.uniform(-760.0, 720.0); }) == 0);
  CHECK(disagreements([](auto x, auto) { return krater::exp(x); },
                      [](Random& r) { return r.uniform(-2.0, 2.0); }) == 0);
  CHECK(disagreements([](auto x, auto) { return krater::log(x); }, any_double) == 0);
  CHECK(disagreements([](auto x, auto) { return krater::log(x); },
                      [](Random& r) { return r.uniform(0.5, 2.0); }) == 0);
  CHECK(disagreements([](auto x, auto y) { return krater::pow(x, y); }, any_double) == 0);
  CHECK(disagreements([](auto x, auto y) { return krater::pow(x, y); },
                      [](Random& r) { return r.logarithmic(1e-12, 10.0); }) == 0);
  CHECK(disagreements([](auto x, auto) { return krater::rcbrt(x); }, any_double) == 0);
}

TEST_CASE("exp: error") {
  const auto error = [](double x) {
    return error_in_ulp(krater::exp(x), std::exp(static_cast<long double>(x)));
  };
  CHECK(worst([](Random& r) { return r.uniform(-1.0, 1.0); }, error) < 1.1);
  CHECK(worst([](Random& r) { return r.uniform(-745.0, 709.7); }, error) < 1.1);
}

TEST_CASE("log: error") {
  const auto error = [](double x) {
    return error_in_ulp(krater::log(x), std::log(static_cast<long double>(x)));
  };
  CHECK(worst([](Random& r) { return r.uniform(0.4, 2.5); }, error) < 1.1);
  CHECK(worst([](Random& r) { return r.logarithmic(1e-307, 1e308); }, error) < 1.1);
  CHECK(worst([](Random& r) { return 1.0 + r.uniform(-1.0, 1.0) * r.logarithmic(1e-15, 0.5); },
              error) < 1.1);
  CHECK(worst([](Random& r) { return 5e-324 * std::floor(r.logarithmic(1.0, 1e15)); }, error) <
        1.1);
}

TEST_CASE("pow: error grows with |y log x|") {
  struct Arguments {
    double x, y;
  };
  const auto error = [](Arguments a) {
    return error_in_ulp(krater::pow(a.x, a.y),
                        std::pow(static_cast<long double>(a.x), static_cast<long double>(a.y)));
  };
  const double range[] = {1.0, 10.0, 50.0, 200.0, 700.0};
  const double bound[] = {1.3, 1.5, 3.0, 10.0, 40.0};
  for (int i = 0; i < 5; ++i) {
    const auto draw = [&](Random& r) {
      const double x = std::exp(r.uniform(-range[i], range[i]) * r.uniform(0.01, 1.0));
      return Arguments{x, r.uniform(-range[i], range[i]) / std::log(x)};
    };
    CHECK(worst(draw, error) < bound[i]);
  }
  // The use in the strength laws: strain^n, (T*)^m.
  const auto law = [](Random& r) {
    return Arguments{r.logarithmic(1e-12, 3.0), r.uniform(0.05, 3.0)};
  };
  CHECK(worst(law, error) < 3.0);
  const auto identity = [](Random& r) { return Arguments{r.logarithmic(1e-3, 1e3), 1.0}; };
  CHECK(worst(identity, error) < 1.5);
}

TEST_CASE("rcbrt: error") {
  const auto error = [](double x) {
    const long double root = 1.0L / std::cbrt(static_cast<long double>(x));
    return error_in_ulp(krater::rcbrt(x), root);
  };
  CHECK(worst([](Random& r) { return r.logarithmic(1e-307, 1e308); }, error) < 1.2);
  CHECK(worst([](Random& r) { return r.uniform(0.3, 3.0); }, error) < 1.2);
}

TEST_CASE("edges") {
  CHECK(krater::exp(0.0) == 1.0);
  CHECK(krater::exp(710.0) == inf);
  CHECK(krater::exp(inf) == inf);
  CHECK(krater::exp(-746.0) == 0.0);
  CHECK(krater::exp(-inf) == 0.0);
  CHECK(krater::exp(-745.0) == 5e-324);
  CHECK(std::isnan(krater::exp(not_a_number)));

  CHECK(same(krater::log(1.0), 0.0));
  CHECK(krater::log(0.0) == -inf);
  CHECK(krater::log(-0.0) == -inf);
  CHECK(krater::log(inf) == inf);
  for (const double x : {-1.0, -inf, -5e-324, not_a_number}) {
    CHECK(std::isnan(krater::log(x)));
    CHECK(std::isnan(krater::rcbrt(x)));
    CHECK(std::isnan(krater::pow(x, 1.5)));
    CHECK(krater::pow(x, 0.0) == 1.0);
    CHECK(krater::pow(1.0, x) == 1.0);
  }
  for (const double y : {1e-3, 0.5, 1.0, 7.0, 1e300, inf}) {
    CHECK(same(krater::pow(0.0, y), 0.0));
    CHECK(same(krater::pow(-0.0, y), 0.0));
    CHECK(krater::pow(0.0, -y) == inf);
    CHECK(krater::pow(inf, y) == inf);
    CHECK(krater::pow(inf, -y) == 0.0);
    CHECK(krater::pow(1.0, y) == 1.0);
  }
  CHECK(krater::pow(2.0, inf) == inf);
  CHECK(krater::pow(0.5, inf) == 0.0);
  CHECK(krater::pow(2.0, 1e300) == inf);
  CHECK(krater::pow(2.0, -1e300) == 0.0);
  CHECK(krater::pow(2.0, -1074.0) == 5e-324);
  CHECK(std::isnan(krater::pow(2.0, not_a_number)));

  CHECK(krater::rcbrt(0.0) == inf);
  CHECK(krater::rcbrt(-0.0) == inf);
  CHECK(krater::rcbrt(inf) == 0.0);
  CHECK(krater::rcbrt(1.0) == 1.0);
  CHECK(krater::rcbrt(8.0) == 0.5);
  CHECK(krater::rcbrt(5e-324) == 0x1p358);
}
