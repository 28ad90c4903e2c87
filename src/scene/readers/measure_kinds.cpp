// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/scene/measures.hpp"

#include <cstddef>
#include <iterator>

namespace krater {

namespace {

using enum MeasureKind;

// kind, name, unit, keys, selects, whole, round, turns, in_history, meaning
constexpr MeasureKindInfo kKinds[] = {
    {extent, "extent", "m", "axis", true, false, false, false, true,
     "size of the body along an axis"},
    {max, "max", "m", "axis", true, false, false, false, true, "highest place of its surface"},
    {min, "min", "m", "axis", true, false, false, false, true, "lowest place of its surface"},
    {diameter, "diameter", "m", "at", true, false, false, false, true, "diameter at a height"},
    {largest_diameter, "largest_diameter", "m", "within", true, false, false, false, false,
     "largest diameter over all heights, or those near the lower end"},
    {mean_velocity, "mean_velocity", "m/s", "direction", true, false, false, false, true,
     "momentum / mass"},
    {momentum, "momentum", "kg m/s", "direction", true, false, false, false, true, "sum m v"},
    {deceleration, "deceleration", "m/s^2", "direction", true, false, false, false, true,
     "fall of |mean velocity| since the last row, by time"},
    {settling_time, "settling_time", "s", "direction", true, false, false, false, false,
     "time from which the mean velocity stays within 1 % of its whole change from its last "
     "value"},
    {kinetic_energy, "kinetic_energy", "J", "", true, false, false, false, true, "sum m v.v / 2"},
    {internal_energy, "internal_energy", "J", "", true, false, false, false, true, "sum m e"},
    {mass, "mass", "kg", "", true, false, false, false, true, "sum m"},
    {removed_mass, "removed_mass", "kg", "", false, false, false, false, true,
     "mass at the start less mass now"},
    {failed_mass, "failed_mass", "kg", "", true, false, false, false, true,
     "mass of failed points"},
    {mass_lost, "mass_lost", "kg", "", false, false, false, false, true, "removed and failed mass"},
    {mean, "mean", "", "field", true, false, false, false, true,
     "sum m q / sum m of a scalar field"},
    {maximum, "maximum", "", "field mass_share", true, false, false, false, true,
     "largest value of a scalar field that a share of the mass reaches"},
    {minimum, "minimum", "", "field mass_share", true, false, false, false, true,
     "smallest value of a scalar field that a share of the mass reaches"},
    {penetration_depth, "penetration_depth", "m", "target face", true, false, false, false, true,
     "how far the body's front is beyond the target's original face"},
    {crater_depth, "crater_depth", "m", "z_face", true, true, false, false, false,
     "deepest place of the surface below the original face"},
    {crater_diameter, "crater_diameter", "m", "z_face level", true, true, false, false, false,
     "diameter of the crater at a level below the original face"},
    {hole_diameter, "hole_diameter", "m", "", true, true, true, false, false,
     "narrowest diameter of the hole through a plate across z; 0: none"},
    {debris_extent, "debris_extent", "m", "axis mass_share", true, false, false, false, true,
     "length or width that holds a share of the mass"},
    {fragments, "fragments", "1", "", true, false, false, false, false,
     "number of pieces of at least least_points points; listed in summary.json"},
    {impulse, "impulse", "N s", "by direction", false, false, false, false, true,
     "what another body or a side of the domain gave the body so far"},
    {force, "force", "N", "by direction", false, false, false, false, true,
     "rise of that impulse since the last row, by time"},
    {angular_momentum, "angular_momentum", "kg m^2/s", "turn", true, false, false, true, true,
     "sum m (x - c) x v about the body's own centre"},
    {obliquity, "obliquity", "rad", "direction", true, false, false, true, true,
     "angle of the mean velocity to a line"},
    {yaw, "yaw", "rad", "", true, false, false, true, true,
     "angle of the body's long axis to its mean velocity"},
    {tilt, "tilt", "rad", "direction", true, false, false, true, true,
     "angle of the body's long axis to a line"},
    {sound_mass, "sound_mass", "kg", "", true, false, false, false, true,
     "mass of the points that have not failed"},
    {bulge, "bulge", "m", "face", true, true, false, false, false,
     "highest place of the surface beyond the original face: bulge, lip or petals"},
};

}  // namespace

const std::vector<MeasureKindInfo>& measure_kinds() {
  static const std::vector<MeasureKindInfo> kinds{std::begin(kKinds), std::end(kKinds)};
  return kinds;
}

Triple direction_of(const MeasureOptions& measure) {
  if (measure.axis < 0) return measure.direction;
  Triple out{};
  out[static_cast<std::size_t>(measure.axis)] = 1;
  return out;
}

const MeasureKindInfo& info(MeasureKind kind) {
  return measure_kinds()[static_cast<std::size_t>(kind)];
}

}  // namespace krater
