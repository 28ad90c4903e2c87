// SPDX-License-Identifier: GPL-3.0-or-later
// Every operation of Pack against the scalar overload, lane by lane and bit by bit, on ordinary and
// special values.
#include "krater/core/simd.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>

#include "krater/core/simd_rows.hpp"

using krater::Mask;
using krater::Pack;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double specials[] = {0.0,     -0.0,    1.0,      -1.0,      0.5,          1.5,
                               -2.5,    3.0,     inf,      -inf,      not_a_number, 5e-324,
                               -1e-310, 1e308,   -1e308,   0x1p-1022, 1e16,         -0.9999,
                               0x1p52,  -0x1p53, 0x1.8p51, 7.25,      -7.75,        1e-8};
constexpr int special_count = sizeof(specials) / sizeof(specials[0]);

/// Equal bits, or both NaN: the sign and payload of a NaN are outside the contract.
bool same(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
  return std::memcmp(&a, &b, sizeof a) == 0;
}

struct Batch {
  alignas(64) double v[8];
};

/// Batches in which every special value meets every other in many lanes, then random ones.
template <class Visit>
void for_batches(Visit visit) {
  for (int shift = 0; shift < special_count; ++shift)
    for (int start = 0; start < special_count; ++start) {
      Batch a, b, c;
      for (int i = 0; i < 8; ++i) {
        a.v[i] = specials[(start + i) % special_count];
        b.v[i] = specials[(start + i + shift) % special_count];
        c.v[i] = specials[(start + 5 * i + 3 * shift) % special_count];
      }
      visit(a, b, c);
    }
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> uniform(-1e3, 1e3);
  for (int trial = 0; trial < 2000; ++trial) {
    Batch a, b, c;
    for (int i = 0; i < 8; ++i) {
      a.v[i] = uniform(generator);
      b.v[i] = uniform(generator);
      c.v[i] = -a.v[i] * b.v[i];  // fma then returns the rounding error alone
    }
    visit(a, b, c);
  }
}

/// Number of lanes in which `operation` on packs and on doubles disagree.
template <class Operation>
int disagreements(Operation operation) {
  int wrong = 0;
  for_batches([&](const Batch& a, const Batch& b, const Batch& c) {
    Batch out;
    krater::store(out.v, operation(krater::load(a.v), krater::load(b.v), krater::load(c.v)));
    for (int i = 0; i < 8; ++i)
      if (!same(out.v[i], operation(a.v[i], b.v[i], c.v[i]))) ++wrong;
  });
  return wrong;
}

template <class Comparison>
int mask_disagreements(Comparison comparison) {
  int wrong = 0;
  for_batches([&](const Batch& a, const Batch& b, const Batch&) {
    const Mask m = comparison(krater::load(a.v), krater::load(b.v));
    unsigned expected = 0;
    for (int i = 0; i < 8; ++i) expected |= (comparison(a.v[i], b.v[i]) ? 1U : 0U) << i;
    if (krater::bits(m) != expected) ++wrong;
    if (krater::any(m) != (expected != 0) || krater::all(m) != (expected == 0xff)) ++wrong;
    if (krater::none(m) != (expected == 0)) ++wrong;
  });
  return wrong;
}

}  // namespace

TEST_CASE("Pack: arithmetic has the bits of the scalar operation") {
  CHECK(disagreements([](auto a, auto b, auto) { return a + b; }) == 0);
  CHECK(disagreements([](auto a, auto b, auto) { return a - b; }) == 0);
  CHECK(disagreements([](auto a, auto b, auto) { return a * b; }) == 0);
  CHECK(disagreements([](auto a, auto b, auto) { return a / b; }) == 0);
  CHECK(disagreements([](auto a, auto, auto) { return -a; }) == 0);
  CHECK(disagreements([](auto a, auto b, auto c) { return a * b + c; }) == 0);
  CHECK(disagreements([](auto a, auto b, auto c) { return krater::fma(a, b, c); }) == 0);
  CHECK(disagreements([](auto a, auto b, auto c) { return krater::fms(a, b, c); }) == 0);
  CHECK(disagreements([](auto a, auto b, auto c) { return krater::fnma(a, b, c); }) == 0);
  CHECK(disagreements([](auto a, auto, auto) { return krater::sqrt(a); }) == 0);
  CHECK(disagreements([](auto a, auto, auto) { return krater::abs(a); }) == 0);
  CHECK(disagreements([](auto a, auto, auto) { return krater::floor(a); }) == 0);
  CHECK(disagreements([](auto a, auto b, auto) { return krater::min(a, b); }) == 0);
  CHECK(disagreements([](auto a, auto b, auto) { return krater::max(a, b); }) == 0);
  CHECK(disagreements([](auto a, auto b, auto c) { return krater::clamp(a, b, c); }) == 0);
  CHECK(disagreements([](auto a, auto b, auto c) {
          a += b;
          a *= 3.0;
          a -= 2.0 * c;
          a /= b - 1.0;
          return 1.0 / (a + 0.5);
        }) == 0);
}

TEST_CASE("scalar operations against the C library") {
  for (const double a : specials)
    for (const double b : specials) {
      CHECK(same(krater::fma(a, b, 0.1), std::fma(a, b, 0.1)));
      CHECK(same(krater::fms(a, b, 0.1), std::fma(a, b, -0.1)));
      CHECK(same(krater::fnma(a, b, 0.1), std::fma(-a, b, 0.1)));
      CHECK(same(krater::min(a, b), a < b ? a : b));
      CHECK(same(krater::max(a, b), a > b ? a : b));
    }
  for (const double a : specials) {
    CHECK(same(krater::sqrt(a), std::sqrt(a)));
    CHECK(same(krater::floor(a), std::floor(a)));
    CHECK(same(krater::abs(a), std::fabs(a)));
    CHECK(krater::is_finite(a) == std::isfinite(a));
    CHECK(same(krater::clamp(a, -2.0, 3.0),
               std::isnan(a) ? not_a_number : std::fmin(3.0, std::fmax(-2.0, a))));
  }
  // The product is not rounded before the sum, and is where no fma is written.
  CHECK(krater::fma(1.0 + 0x1p-52, 1.0 + 0x1p-52, -(1.0 + 0x1p-51)) == 0x1p-104);
}

TEST_CASE("Pack: comparisons and masks") {
  CHECK(mask_disagreements([](auto a, auto b) { return a < b; }) == 0);
  CHECK(mask_disagreements([](auto a, auto b) { return a <= b; }) == 0);
  CHECK(mask_disagreements([](auto a, auto b) { return a > b; }) == 0);
  CHECK(mask_disagreements([](auto a, auto b) { return a >= b; }) == 0);
  CHECK(mask_disagreements([](auto a, auto b) { return a == b; }) == 0);
  CHECK(mask_disagreements([](auto a, auto b) { return a != b; }) == 0);
  CHECK(mask_disagreements([](auto a, auto) { return krater::is_finite(a); }) == 0);
  CHECK(mask_disagreements([](auto a, auto b) { return (a < b) & (a > -1.0); }) == 0);
  CHECK(mask_disagreements([](auto a, auto b) { return (a < b) | (b > 2.0); }) == 0);
  CHECK(mask_disagreements([](auto a, auto b) { return (a < b) ^ (b > 0.0); }) == 0);
  CHECK(mask_disagreements([](auto a, auto b) { return !(a < b); }) == 0);
  CHECK(disagreements([](auto a, auto b, auto c) { return krater::select(a < b, c, b); }) == 0);
  CHECK(disagreements([](auto a, auto, auto) { return krater::select(a >= 0.0, a, 0.0); }) == 0);
  for (int n = 0; n <= 8; ++n) CHECK(krater::bits(krater::first_lanes(n)) == (1U << n) - 1U);
}

TEST_CASE("Pack: lanes, loads, folds and blends") {
  alignas(64) double in[16];
  alignas(64) double out[16] = {};
  for (int i = 0; i < 16; ++i) in[i] = 1.0 / (i + 3) + (i % 3 == 0 ? 1e15 : 0.0);
  Pack a = krater::load(in);
  for (int i = 0; i < 8; ++i) CHECK(krater::get(a, i) == in[i]);
  krater::storeu(out + 3, krater::loadu(in + 5));
  for (int i = 0; i < 8; ++i) CHECK(out[3 + i] == in[5 + i]);
  CHECK(out[2] == 0.0);
  CHECK(out[11] == 0.0);
  CHECK(krater::get(krater::load_as<Pack>(in), 7) == in[7]);
  CHECK(krater::load_as<double>(in + 7) == in[7]);

  const double low = (in[0] + in[4]) + (in[2] + in[6]);
  const double high = (in[1] + in[5]) + (in[3] + in[7]);
  CHECK(krater::sum(a) == low + high);
  CHECK(krater::sum(in[1]) == in[1]);
  for (int i = 0; i < 8; ++i) {
    Pack b = a;
    krater::set(b, i, -5.0);
    CHECK(krater::hmin(b) == -5.0);
    krater::set(b, i, 1e300);
    CHECK(krater::hmax(b) == 1e300);
    for (int j = 0; j < 8; ++j) CHECK(krater::get(b, j) == (i == j ? 1e300 : in[j]));
  }
  const Pack zero = 0.0;
  for (int i = 0; i < 8; ++i) {
    CHECK(krater::get(krater::blend_low<0>(a, zero), i) == 0.0);
    CHECK(krater::get(krater::blend_low<3>(a, zero), i) == (i < 3 ? in[i] : 0.0));
    CHECK(krater::get(krater::blend_low<6>(a, zero), i) == (i < 6 ? in[i] : 0.0));
    CHECK(krater::get(krater::blend_low<8>(a, zero), i) == in[i]);
  }
  CHECK(krater::lanes_of<Pack> == 8);
  CHECK(krater::lanes_of<double> == 1);
}

TEST_CASE("transpose8: in memory and in registers") {
  alignas(64) double in[64];
  alignas(64) double out[64];
  Pack r[8];
  for (int i = 0; i < 64; ++i) in[i] = i;
  for (int i = 0; i < 8; ++i) r[i] = krater::load(in + 8 * i);
  krater::transpose8(in, out);
  krater::transpose8(r);
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j) {
      CHECK(out[8 * i + j] == 8 * j + i);
      CHECK(krater::get(r[i], j) == 8 * j + i);
    }
}

TEST_CASE("load_columns: four columns of rows anywhere") {
  alignas(64) double in[8 * 24];
  for (int i = 0; i < 8 * 24; ++i) in[i] = i;
  const int place[8] = {16, 3, 7, 0, 9, 1, 23, 12};
  const auto row = [&](int l) { return in + 8 * place[l]; };
  for (const int column : {0, 4}) {
    Pack out[4];
    krater::load_columns(row, column, out);
    for (int c = 0; c < 4; ++c)
      for (int l = 0; l < 8; ++l) CHECK(krater::get(out[c], l) == 8 * place[l] + column + c);
  }
  Pack all[8];
  krater::load_rows(row, all);
  for (int c = 0; c < 8; ++c)
    for (int l = 0; l < 8; ++l) CHECK(krater::get(all[c], l) == 8 * place[l] + c);
}

TEST_CASE("split_exponent and scale_pow2: exact, denormals included") {
  const double values[] = {0.0,    -0.0,   1.0,       0.75,  1.5, 0x1.7ffffffffffffp0,
                           5e-324, 3e-310, 0x1p-1022, 1e308, inf};
  for (const double x : values) {
    const auto scalar = krater::split_exponent(x);
    const auto pack = krater::split_exponent(Pack(x));
    CHECK(same(scalar.exponent, krater::get(pack.exponent, 2)));
    CHECK(same(scalar.mantissa, krater::get(pack.mantissa, 5)));
    if (x > 0.0 && x < inf) {
      CHECK(scalar.mantissa >= 0.75);
      CHECK(scalar.mantissa < 1.5);
      CHECK(std::ldexp(scalar.mantissa, static_cast<int>(scalar.exponent)) == x);
    }
  }
  CHECK(krater::split_exponent(0.0).exponent == -inf);
  CHECK(krater::split_exponent(inf).exponent == inf);
  for (const double x : {-1.0, -inf, not_a_number, -1e-320}) {
    CHECK(std::isnan(krater::split_exponent(x).mantissa));
    CHECK(std::isnan(krater::get(krater::split_exponent(Pack(x)).mantissa, 0)));
  }
  for (int n = -1100; n <= 1100; ++n)
    for (const double x : {1.0, 1.0 + 0x1p-52, 0.7071067811865475, 1.9999999999}) {
      CHECK(same(krater::scale_pow2(x, n), std::ldexp(x, n)));
      CHECK(same(krater::get(krater::scale_pow2(Pack(x), Pack(n)), 4), std::ldexp(x, n)));
    }
}
