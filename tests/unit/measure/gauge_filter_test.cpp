// SPDX-License-Identifier: GPL-3.0-or-later
// Filters of gauges: what they leave of a sine, and where.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "krater/measure/gauge_filter.hpp"

using namespace krater;

namespace {

constexpr double kEvery = 1e-6;

std::vector<double> sine(double f, std::size_t n) {
  std::vector<double> out;
  for (std::size_t i = 0; i < n; ++i)
    out.push_back(std::sin(2 * std::numbers::pi * f * kEvery * static_cast<double>(i)));
  return out;
}

/// Amplitude of the component at f in the middle half, and its phase [rad].
struct Response {
  double gain, phase;
};
Response response(GaugeFilter filter, double cut, double f) {
  const std::vector<double> x = filtered(sine(f, 4000), kEvery, filter, cut);
  double s = 0, c = 0;
  for (std::size_t i = 1000; i < 3000; ++i) {
    const double angle = 2 * std::numbers::pi * f * kEvery * static_cast<double>(i);
    s += x[i] * std::sin(angle) / 1000;
    c += x[i] * std::cos(angle) / 1000;
  }
  return {std::hypot(s, c), std::atan2(c, s)};
}

}  // namespace

TEST_CASE(
    "gauge filters: butterworth is 3 dB down at its frequency, 1/(1 + (f/f_c)^4), without phase") {
  const double cut = 5e3, pass = cut / std::pow(std::numbers::sqrt2 - 1, 0.25);
  for (const double f : {500.0, 2e3, 5e3, 10e3, 20e3}) {
    CAPTURE(f);
    const double warped =
        std::tan(std::numbers::pi * f * kEvery) / std::tan(std::numbers::pi * pass * kEvery);
    const Response r = response(GaugeFilter::butterworth, cut, f);
    CHECK(r.gain == doctest::Approx(1 / (1 + std::pow(warped, 4))).epsilon(1e-3));
    CHECK(std::abs(r.phase) < 1e-3);
  }
  CHECK(response(GaugeFilter::butterworth, cut, cut).gain ==
        doctest::Approx(std::sqrt(0.5)).epsilon(1e-3));
}

TEST_CASE("gauge filters: a moving mean has the sinc of its length") {
  const Response r = response(GaugeFilter::moving_mean, 10e3, 4e3);  // over 101 samples
  const double n = 101, half = std::numbers::pi * 4e3 * kEvery;
  CHECK(r.gain ==
        doctest::Approx(std::abs(std::sin(n * half) / (n * std::sin(half)))).epsilon(1e-3));
}

TEST_CASE("gauge filters: constants and straight lines stay, also at the ends") {
  for (const GaugeFilter filter : {GaugeFilter::butterworth, GaugeFilter::moving_mean}) {
    std::vector<double> line;
    for (int i = 0; i < 500; ++i) line.push_back(3 + 0.01 * i);
    const std::vector<double> out = filtered(line, kEvery, filter, 20e3);
    REQUIRE(out.size() == line.size());
    for (std::size_t i = 0; i < line.size(); ++i) CHECK(std::abs(out[i] - line[i]) < 2e-3);
  }
}

TEST_CASE("gauge filters: uneven samples become even ones") {
  const std::vector<double> even = resampled({0, 1, 4, 5}, {0, 2, 8, 10}, 0.5);
  REQUIRE(even.size() == 11);
  for (std::size_t i = 0; i < even.size(); ++i)
    CHECK(even[i] == doctest::Approx(static_cast<double>(i)));
}
