// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file measure/gauges.hpp
/// Gauges: records at points of a body or of space, each by its own clock, after the steps that
/// reach k * every. A gauge in the material is the point nearest to its place at the start, so at a
/// free surface it tells the velocity that a VISAR sees, from a quarter of a cell below it. One
/// fixed in space is the mean by mass of the points about it, weighted with a hat one cell wide; it
/// tells nothing (nan) where no material is. A gauge over a section is the body's plane cut through
/// its place, which goes with the material point nearest to it or is fixed in space: means over its
/// area, and what passes it (measure/gauge_section.hpp). Fields: measure/gauge_fields.hpp. A gauge
/// of `measures` records numbers of the scene's measures block (forces, momenta, depths) by its own
/// clock: as they are, without `keep`; force and deceleration are those of the time since its last
/// sample. Records stand in the checkpoint and are written whole at the end: gauge_NAME.csv, and
/// the group gauges/NAME of history.h5.
#include <optional>
#include <string>
#include <vector>

#include "krater/measure/gauge_fields.hpp"
#include "krater/measure/gauge_filter.hpp"
#include "krater/measure/gauge_section.hpp"
#include "krater/measure/measurements.hpp"
#include "krater/simulation/simulation.hpp"

namespace krater {

class Gauges {
 public:
  /// Of a simulation at its start. Throws InputError: a place outside the body, a field that it
  /// does not carry.
  Gauges(const Simulation& sim, Measurements& measurements);

  /// After a step.
  void look(const Simulation& sim);
  bool due(double time) const;  ///< a look then reads points
  /// What belongs into summary.json: `gauges`.
  void summarize(Json& summary) const;
  void write(ResultsFolder& results) const;
  /// "gauge visar: nothing is there since 2e-06 s", for the user.
  std::vector<std::string> sentences() const;

  void save(Checkpoint& checkpoint) const;
  void restore(const Checkpoint& checkpoint);

 private:
  struct Record {
    std::vector<double> ids;     ///< of the material points
    std::vector<double> offset;  ///< of a section from its material point, along its normal [m]
    std::vector<GaugeField> fields;
    double next = 0;  ///< [s]
    std::vector<double> time;
    std::vector<std::vector<double>> values;  ///< by place and field
    std::vector<double> gone;                 ///< by place: when it was missed first [s]; -1: never
  };
  double find_id(const Simulation& sim, const GaugeOptions& gauge, std::size_t place) const;
  std::vector<std::optional<SectionPlane>> planes(const Simulation& sim, std::size_t g,
                                                  const SectionReader& reader) const;
  void sample(const Simulation& sim, std::size_t g);
  void sample_points(const Simulation& sim, std::size_t g);
  void place_sections(const Simulation& sim, std::size_t g);
  void sample_sections(const Simulation& sim, std::size_t g);
  /// weight(place, set, point), value(place, field, set, point).
  template <class Weight, class Value>
  void sample_body(const Simulation& sim, std::size_t g, const Weight& weight, const Value& value);
  void sample_measures(const Simulation& sim, std::size_t g);
  const std::string& body_name(const GaugeOptions& gauge) const;
  std::string column_name(std::size_t g, std::size_t column) const;
  std::vector<TableColumn> table(std::size_t g) const;

  const Scene& scene_;
  Measurements& measurements_;
  std::vector<Record> records_;
};

}  // namespace krater
