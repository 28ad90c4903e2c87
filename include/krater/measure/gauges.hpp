// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file measure/gauges.hpp
/// Gauges: records at points of a body or of space, each by its own clock, after the steps that
/// reach k * every. A gauge in the material is the point nearest to its place at the start, so at a
/// free surface it tells the velocity that a VISAR sees, from a quarter of a cell below it. One
/// fixed in space is the mean by mass of the points about it, weighted with a hat one cell wide; it
/// tells nothing (nan) where no material is. Fields: position, velocity, stress by component
/// (velocity_z, stress_xx, stress_rr), speed, von_mises, every scalar that the points carry, and
/// NAME_rate, the difference of two samples over the time between. Records stand in the checkpoint
/// and are written whole at the end: gauge_NAME.csv, gauge_NAME.h5.
#include <string>
#include <vector>

#include "krater/measure/gauge_filter.hpp"
#include "krater/simulation/simulation.hpp"

namespace krater {

class Gauges {
 public:
  /// Of a simulation at its start. Throws InputError: a place outside the body, a field that it
  /// does not carry.
  explicit Gauges(const Simulation& sim);

  /// After a step.
  void look(const Simulation& sim);
  /// What belongs into summary.json: `gauges`.
  void summarize(Json& summary) const;
  void write(ResultsFolder& results) const;

  void save(Checkpoint& checkpoint) const;
  void restore(const Checkpoint& checkpoint);

 private:
  /// A field of the points: where it lies, and what is made of it.
  struct Source {
    enum class Kind { scalar, speed, stress, von_mises };
    Kind kind = Kind::scalar;
    int slot = -1, pressure = -1;
    const char* unit = "1";
    bool rate = false;
  };
  struct Record {
    std::vector<double> ids;      ///< of the material points
    std::vector<Source> sources;  ///< by field
    double next = 0;              ///< [s]
    std::vector<double> time;
    std::vector<std::vector<double>> values;  ///< by place and field
    std::vector<double> gone;                 ///< by place: when it was missed first [s]; -1: never
  };
  Source find_source(const Simulation& sim, const GaugeOptions& gauge, std::string name) const;
  double find_id(const Simulation& sim, const GaugeOptions& gauge, std::size_t place) const;
  void sample(const Simulation& sim, std::size_t g);
  std::string column_name(std::size_t g, std::size_t column) const;
  std::vector<TableColumn> table(std::size_t g) const;

  const Scene& scene_;
  std::vector<Record> records_;
};

}  // namespace krater
