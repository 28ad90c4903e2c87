// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/measure/measure_series.hpp"

#include <algorithm>
#include <cmath>

namespace krater {

namespace {

constexpr double kSettled = 0.01;  // of the whole change

/// The value of a kind that looks back, or the sample itself.
double value_of(MeasureKind kind, const MeasureSeries& series, double sample) {
  if (kind == MeasureKind::deceleration) return deceleration(series);
  if (kind == MeasureKind::force) return rise(series);
  return kind == MeasureKind::settling_time ? settling_time(series) : sample;
}

}  // namespace

bool looks_back(MeasureKind kind) {
  return kind == MeasureKind::deceleration || kind == MeasureKind::settling_time ||
         kind == MeasureKind::force;
}

double deceleration(const MeasureSeries& series) {
  const std::size_t n = series.time.size();
  if (n < 2) return 0;
  return -(std::abs(series.sample[n - 1]) - std::abs(series.sample[n - 2])) /
         (series.time[n - 1] - series.time[n - 2]);
}

double rise(const MeasureSeries& series) {
  const std::size_t n = series.time.size();
  if (n < 2) return 0;
  return (series.sample[n - 1] - series.sample[n - 2]) / (series.time[n - 1] - series.time[n - 2]);
}

double settling_time(const MeasureSeries& series) {
  if (series.time.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double last = series.sample.back();
  double change = 0;
  for (const double v : series.sample) change = std::max(change, std::abs(v - last));
  const double band = kSettled * change;
  std::size_t i = series.time.size() - 1;
  while (i > 0 && std::abs(series.sample[i - 1] - last) <= band) --i;
  if (i == 0) return series.time.front();
  const double before = std::abs(series.sample[i - 1] - last),
               after = std::abs(series.sample[i] - last);
  const bool same_side = (series.sample[i - 1] > last) == (series.sample[i] > last);
  const double share = (before - band) / (before - (same_side ? after : -after));
  return series.time[i - 1] + share * (series.time[i] - series.time[i - 1]);
}

double follow(const MeasureOptions& measure, MeasureSeries& series, double time, double sample) {
  if (looks_back(measure.kind) && std::isfinite(sample) &&
      (series.time.empty() || time > series.time.back())) {
    series.time.push_back(time);
    series.sample.push_back(sample);
  }
  const double value = value_of(measure.kind, series, sample);
  if (measure.keep == Keep::now) return value;
  const bool further = measure.keep == Keep::largest ? value > series.kept : value < series.kept;
  if (std::isnan(series.kept) || further) {
    series.kept = value;
    series.kept_time = time;
  }
  return series.kept;
}

}  // namespace krater
