// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file measure/gauge_fields.hpp
/// What a gauge may record of a point: position and velocity by component (velocity_z), every
/// scalar that the points carry, and
///   stress_zz   Cauchy stress, s - p 1, tension positive
///   speed       |v|                      von_mises   sqrt(3/2 s:s)
///   strain_zz   logarithmic (Hencky) strain h = 1/2 ln(F F^T), in the present configuration: of a
///               bar pulled from l0 to l it is ln(l/l0); shear components are those of the tensor,
///               half the engineering shear. F is the product of the steps' own maps (no cell
///               averages); a body carries it where a gauge asks.
/// Components rr tt zz rz about the axis, else xx yy zz xz ...; each with _rate: the difference of
/// two samples over the time between.
#include <string>

#include "krater/simulation/simulation.hpp"

namespace krater {

struct GaugeField {
  enum class Kind {
    scalar,
    speed,
    stress,
    von_mises,
    strain,
    measure,
    area,  ///< from here on of a section (measure/gauge_section.hpp)
    force,
    mass_flux,
    momentum_flux
  };
  /// What the record's samples become: the value itself, its rate, or the fall of its size.
  enum class Change { none, rate, fall };
  Kind kind = Kind::scalar;
  int slot = -1;       ///< of the field's first component; of a measure: its number
  int pressure = -1;   ///< slot to take off, -1: none
  int component = -1;  ///< of strain; of what passes a section: its grid axis
  std::string unit = "1";
  Change change = Change::none;
  /// Summed over a section, where others are a mean.
  bool is_sum() const { return kind >= Kind::area; }
};

/// Throws InputError: the points of the gauge's body carry no such field.
GaugeField find_gauge_field(const Simulation& sim, const GaugeOptions& gauge, std::string name);
/// Of a measure of the scene, or its rate.
GaugeField measure_field(const Scene& scene, int measure, const std::string& name);
/// At a point of a set, as it is recorded.
double value_at(const Simulation& sim, const GaugeField& field, int set, int point);
/// Samples as they are written.
std::vector<double> changed(const GaugeField& field, const std::vector<double>& time,
                            std::vector<double> samples);

}  // namespace krater
