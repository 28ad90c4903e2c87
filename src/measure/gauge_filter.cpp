// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/measure/gauge_filter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace krater {

namespace {

/// One pass of the two poles, from the state of rest at the first sample.
void pass(std::vector<double>& x, double wa) {
  const double root = std::numbers::sqrt2 * wa, scale = 1 / (1 + root + wa * wa);
  const double a = wa * wa * scale, b1 = -2 * (wa * wa - 1) * scale,
               b2 = (-1 + root - wa * wa) * scale;
  double x1 = x[0], x2 = x[0], y1 = x[0], y2 = x[0];
  for (double& sample : x) {
    const double now = sample, y = a * (now + 2 * x1 + x2) + b1 * y1 + b2 * y2;
    x2 = x1;
    x1 = now;
    y2 = y1;
    y1 = sample = y;
  }
}

std::vector<double> butterworth(const std::vector<double>& samples, double every, double f) {
  const double cut = f / std::pow(std::numbers::sqrt2 - 1, 0.25),
               wa = std::tan(std::numbers::pi * cut * every);
  const std::size_t n = samples.size();
  const std::size_t more = std::min(n - 1, static_cast<std::size_t>(std::ceil(2 / (f * every))));
  std::vector<double> x;
  for (std::size_t i = more; i > 0; --i) x.push_back(2 * samples[0] - samples[i]);
  x.insert(x.end(), samples.begin(), samples.end());
  for (std::size_t i = 1; i <= more; ++i) x.push_back(2 * samples[n - 1] - samples[n - 1 - i]);
  pass(x, wa);
  std::reverse(x.begin(), x.end());
  pass(x, wa);
  std::reverse(x.begin(), x.end());
  const auto first = x.begin() + static_cast<std::ptrdiff_t>(more);
  return {first, first + static_cast<std::ptrdiff_t>(n)};
}

std::vector<double> moving_mean(const std::vector<double>& samples, double every, double f) {
  const auto half = static_cast<std::ptrdiff_t>(std::lround(0.5 / (f * every)));
  const auto n = static_cast<std::ptrdiff_t>(samples.size());
  std::vector<double> out;
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const std::ptrdiff_t reach = std::min({half, i, n - 1 - i});
    double sum = 0;
    for (std::ptrdiff_t k = i - reach; k <= i + reach; ++k)
      sum += samples[static_cast<std::size_t>(k)];
    out.push_back(sum / static_cast<double>(2 * reach + 1));
  }
  return out;
}

}  // namespace

std::vector<double> resampled(const std::vector<double>& time, const std::vector<double>& value,
                              double every) {
  std::vector<double> out;
  std::size_t i = 0;
  for (std::size_t k = 0; !time.empty(); ++k) {
    const double t = time.front() + static_cast<double>(k) * every;
    if (t > time.back() + 1e-9 * every) break;
    while (i + 2 < time.size() && time[i + 1] < t) ++i;
    if (time.size() == 1) return value;
    const double share = (t - time[i]) / (time[i + 1] - time[i]);
    out.push_back(value[i] + share * (value[i + 1] - value[i]));
  }
  return out;
}

std::vector<double> filtered(const std::vector<double>& samples, double every, GaugeFilter filter,
                             double frequency) {
  if (samples.size() < 3 || filter == GaugeFilter::none) return samples;
  return filter == GaugeFilter::butterworth ? butterworth(samples, every, frequency)
                                            : moving_mean(samples, every, frequency);
}

}  // namespace krater
