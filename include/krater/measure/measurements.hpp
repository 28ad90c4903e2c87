// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file measure/measurements.hpp
/// The measures of a scene along a run: what they remember of the start (mass, faces) and of the
/// rows of history, their values, their part of summary.json. Points are gathered once per
/// selection and row, in the order in which they are kept (no sorting), only the columns needed.
#include <map>
#include <string>
#include <vector>

#include "krater/measure/measure_series.hpp"
#include "krater/measure/measures.hpp"
#include "krater/simulation/simulation.hpp"

namespace krater {

/// Domain, boundaries and point spacing of bodies, as measures see them.
MeasureContext measure_context(const Simulation& sim, const std::vector<int>& bodies);

/// The points of bodies, body after body, patch after patch. `fields`: scalars wanted; those that
/// not all bodies carry are left out, but for "failed" (0 where a body cannot fail).
BodyPoints gather_points(const Simulation& sim, const std::vector<int>& bodies,
                         const std::vector<std::string>& fields);

/// Number of every point's piece in its body (0 the heaviest), points in the order of their ids.
std::vector<double> fragment_numbers(const Simulation& sim, int body);

class Measurements {
 public:
  /// Of a simulation at its start: before a checkpoint is restored.
  explicit Measurements(const Simulation& sim);

  /// Throws InputError for what cannot be measured.
  void check(const Simulation& sim) const;
  /// Names and units of the columns of history.
  std::vector<Quantity> titles(const Scene& scene) const;
  /// Columns of the next row of history. Remembers it.
  std::vector<Quantity> row(const Simulation& sim);
  /// "measures": value, unit, definition, reference and difference; "fragments": lists of pieces.
  void summarize(const Simulation& sim, Json& summary);

  /// Names of the measures that selected no point in the last summary.
  const std::vector<std::string>& without_points() const { return nothing_; }

  void save(Checkpoint& checkpoint, const Scene& scene) const;
  /// Measures that the checkpoint does not know, or that have `changed` since, start here.
  void restore(const Checkpoint& checkpoint, const Scene& scene,
               const std::vector<std::string>& changed);

 private:
  std::vector<double> values(const Simulation& sim, bool all);

  std::vector<MeasureStart> start_;    ///< by measure
  std::vector<MeasureSeries> series_;  ///< by measure
  std::vector<std::string> nothing_;
};

}  // namespace krater
