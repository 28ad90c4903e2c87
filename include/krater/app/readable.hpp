// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file app/readable.hpp
/// SI numbers in the units that people say them in: mm, us, g, MPa, km/s. Files stay SI. The same
/// ladders as tools/units.py, in ASCII; scene/behaviour_test.py holds them together.
#include <string>

namespace krater {

struct ShownUnit {
  double size = 1;  ///< SI per shown unit
  std::string name;
};

/// The unit to show numbers up to `largest` (of SI unit `unit`) in: 3.1e8 Pa -> {1e6, "MPa"}.
ShownUnit shown_unit(double largest, const std::string& unit);

/// One number with its unit: (0.0254, "m") -> "25.4 mm".
std::string readable(double value, const std::string& unit, int digits = 4);

}  // namespace krater
