// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file measure/measure_series.hpp
/// What measures remember from row to row of the history: the mean velocity for deceleration and
/// settling_time, the impulse for force, the extreme so far for `keep`.
#include <limits>
#include <vector>

#include "krater/scene/measures.hpp"

namespace krater {

struct MeasureSeries {
  std::vector<double> time, sample;  ///< of the kinds that need them; times increase
  double kept = std::numeric_limits<double>::quiet_NaN();       ///< extreme so far
  double kept_time = std::numeric_limits<double>::quiet_NaN();  ///< when it was reached [s]
};

/// Kinds whose value comes from samples of several rows.
bool looks_back(MeasureKind kind);

/// -(|v_n| - |v_n-1|) / (t_n - t_n-1) of the last two samples: the mean deceleration since the last
/// row; 0 with fewer.
double deceleration(const MeasureSeries& series);

/// Rise of the samples since the last row, by time: the mean force where they are impulses; 0 with
/// fewer than two.
double rise(const MeasureSeries& series);

/// Time from which v stays within 1 % of max |v - v_last| of its last value, linear between
/// samples; the first time when v never changed; NaN without samples.
double settling_time(const MeasureSeries& series);

/// Remember a sample of this time (a second one of the same time changes nothing that the first did
/// not) and return the measure's value.
double follow(const MeasureOptions& measure, MeasureSeries& series, double time, double sample);

}  // namespace krater
