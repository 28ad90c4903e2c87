// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/scene/measures.hpp"

#include <cstddef>

namespace krater {

const std::vector<MeasureKindInfo>& measure_kinds() {
  using enum MeasureKind;
  // kind, name, unit, keys, selects, whole, round, in_history, meaning
  static const std::vector<MeasureKindInfo> kinds{
      {extent, "extent", "m", "axis", true, false, false, true, "size of the body along an axis"},
      {max, "max", "m", "axis", true, false, false, true, "highest place of its surface"},
      {min, "min", "m", "axis", true, false, false, true, "lowest place of its surface"},
      {diameter, "diameter", "m", "at", true, false, false, true, "diameter at a height"},
      {largest_diameter, "largest_diameter", "m", "within", true, false, false, false,
       "largest diameter over all heights, or those near the lower end"},
      {mean_velocity, "mean_velocity", "m/s", "axis", true, false, false, true, "momentum / mass"},
      {momentum, "momentum", "kg m/s", "axis", true, false, false, true, "sum m v"},
      {deceleration, "deceleration", "m/s^2", "axis", true, false, false, true,
       "fall of |mean velocity| since the last row, by time"},
      {settling_time, "settling_time", "s", "axis", true, false, false, false,
       "time from which the mean velocity stays within 1 % of its whole change from its last "
       "value"},
      {kinetic_energy, "kinetic_energy", "J", "", true, false, false, true, "sum m v.v / 2"},
      {internal_energy, "internal_energy", "J", "", true, false, false, true, "sum m e"},
      {mass, "mass", "kg", "", true, false, false, true, "sum m"},
      {removed_mass, "removed_mass", "kg", "", false, false, false, true,
       "mass at the start less mass now"},
      {failed_mass, "failed_mass", "kg", "", true, false, false, true, "mass of failed points"},
      {mass_lost, "mass_lost", "kg", "", false, false, false, true, "removed and failed mass"},
      {mean, "mean", "", "field", true, false, false, true, "sum m q / sum m of a scalar field"},
      {maximum, "maximum", "", "field mass_share", true, false, false, true,
       "largest value of a scalar field that a share of the mass reaches"},
      {minimum, "minimum", "", "field mass_share", true, false, false, true,
       "smallest value of a scalar field that a share of the mass reaches"},
      {penetration_depth, "penetration_depth", "m", "target face", true, false, false, true,
       "how far the body's front is beyond the target's original face"},
      {crater_depth, "crater_depth", "m", "z_face", true, true, false, false,
       "deepest place of the surface below the original face"},
      {crater_diameter, "crater_diameter", "m", "z_face level", true, true, false, false,
       "diameter of the crater at a level below the original face"},
      {hole_diameter, "hole_diameter", "m", "", true, true, true, false,
       "narrowest diameter of the hole through a plate across z; 0: none"},
      {debris_extent, "debris_extent", "m", "axis mass_share", true, false, false, true,
       "length or width that holds a share of the mass"},
      {fragments, "fragments", "1", "", true, false, false, false,
       "number of pieces of at least least_points points; listed in summary.json"},
  };
  return kinds;
}

const MeasureKindInfo& info(MeasureKind kind) {
  return measure_kinds()[static_cast<std::size_t>(kind)];
}

}  // namespace krater
