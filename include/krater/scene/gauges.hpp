// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file scene/gauges.hpp
/// Gauges of a scene: what is recorded at a point, by its own clock (measure/gauges.hpp).
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace krater {

enum class GaugeFilter { none, butterworth, moving_mean };

inline constexpr std::string_view kStrain = "strain_";  ///< what a body must carry F for

struct GaugeOptions {
  std::string name, where;
  int body = -1;                          ///< whose points are read; -1: `measures` are
  std::vector<int> measures;              ///< by field, of the scene's
  bool fixed = false;                     ///< in space; else it goes with the material
  std::vector<std::array<double, 3>> at;  ///< along the grid axes, at the start [m]
  /// Of planes through the places, along the grid axes: a gauge over sections; none: at points.
  std::optional<std::array<double, 3>> normal;
  std::vector<std::string> fields;  ///< names of the columns
  double every = 0;                 ///< [s] between samples
  GaugeFilter filter = GaugeFilter::none;
  double frequency = 0;     ///< of -3 dB [Hz]; moving_mean: 1 over its length
  std::string filter_name;  ///< "cfc 1000"
};

}  // namespace krater
