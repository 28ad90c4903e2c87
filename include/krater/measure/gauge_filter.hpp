// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file measure/gauge_filter.hpp
/// Filters of a record, without a shift of phase, on samples a constant time apart:
/// - butterworth: two poles, forwards and backwards (SAE J211-1, annex C). Each pass has
///   |H|^2 = 1/(1 + (f/f_c)^4), both together -3 dB at f with f_c = f/(sqrt(2) - 1)^(1/4). A
///   channel frequency class CFC is this filter at f = 5/3 CFC.
/// - moving_mean: over 1/f about each sample.
/// The record is continued at its ends by its point reflection, so that no step is made there.
#include <vector>

#include "krater/scene/gauges.hpp"

namespace krater {

/// `value` at times `time` (ascending) on k * every from the first on, linear between samples.
std::vector<double> resampled(const std::vector<double>& time, const std::vector<double>& value,
                              double every);
/// Samples `every` [s] apart; `frequency` [Hz].
std::vector<double> filtered(const std::vector<double>& samples, double every, GaugeFilter filter,
                             double frequency);

}  // namespace krater
