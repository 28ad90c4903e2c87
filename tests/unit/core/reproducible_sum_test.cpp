// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/core/reproducible_sum.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <random>
#include <vector>

namespace krater {
namespace {

std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(x); }

double sum_of(const std::vector<double>& terms) {
  ReproducibleSum sum;
  for (const double x : terms) sum += x;
  return sum.value();
}

/// Terms of both signs over 60 powers of ten, and some that nearly cancel.
std::vector<double> wild_terms(std::mt19937_64& random) {
  std::uniform_real_distribution<double> mantissa{-1, 1}, exponent{-30, 30};
  std::vector<double> terms;
  for (int i = 0; i < 500; ++i)
    terms.push_back(mantissa(random) * std::pow(10.0, exponent(random)));
  for (int i = 0; i < 100; ++i) terms.push_back(-terms[static_cast<std::size_t>(i)] * (1 + 1e-15));
  return terms;
}

TEST_CASE("a single term comes back as it was") {
  for (const double x : {1.0, -1.0, 0.1, -3.7e300, 2.3e-300, 1e22 / 3, 0.0, 4294967296.0,
                         -4294967295.5, 1.7976931348623157e308, 2.2250738585072014e-308})
    CHECK(bits(sum_of({x})) == bits(x));
}

TEST_CASE("the order of the terms changes no bit, nor does dealing them out") {
  std::mt19937_64 random{7};
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<double> terms = wild_terms(random);
    const double whole = sum_of(terms);
    std::shuffle(terms.begin(), terms.end(), random);
    CHECK(bits(sum_of(terms)) == bits(whole));
    std::sort(terms.begin(), terms.end());  // the large ones last: the window rises on the way
    CHECK(bits(sum_of(terms)) == bits(whole));
    std::vector<ReproducibleSum> parts(7);
    for (std::size_t i = 0; i < terms.size(); ++i) parts[i * i % 7] += terms[i];
    std::shuffle(parts.begin(), parts.end(), random);
    ReproducibleSum all;
    for (const ReproducibleSum& part : parts) all += part;
    CHECK(bits(all.value()) == bits(whole));
    for (double& x : terms) x = -x;
    CHECK(bits(sum_of(terms)) == bits(-whole));
  }
}

TEST_CASE("it is the sum, to the last place of its largest term") {
  std::mt19937_64 random{11};
  std::uniform_real_distribution<double> value{-1, 1};
  std::vector<double> terms;
  long double exact = 0;
  for (int i = 0; i < 100000; ++i) {
    terms.push_back(value(random));
    exact += static_cast<long double>(terms.back());
  }
  CHECK(std::abs(static_cast<double>(sum_of(terms) - exact)) <= 1e-15 * std::abs(sum_of(terms)));
  // where a plain sum keeps nothing of the small one
  CHECK(sum_of({1e20, 1.0, -1e20}) == 1.0);
}

TEST_CASE("what is not finite is not hidden") {
  CHECK(std::isnan(sum_of({1.0, std::numeric_limits<double>::infinity()})));
  ReproducibleSum sum, other;
  other += std::numeric_limits<double>::quiet_NaN();
  sum += 1.0;
  sum += other;
  CHECK(std::isnan(sum.value()));
}

}  // namespace
}  // namespace krater
