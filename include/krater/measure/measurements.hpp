// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file measure/measurements.hpp
/// The measures of a scene along a run: what they remember of the start (mass, faces) and of the
/// rows of history, their values, their part of summary.json. Points are gathered once per
/// selection and row, in the order in which they are kept (no sorting), only the columns needed,
/// into memory that is kept: what a row allocates and frees the kernel clears again for the next.
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "krater/measure/measure_series.hpp"
#include "krater/measure/measures.hpp"
#include "krater/simulation/simulation.hpp"

namespace krater {

/// Domain, boundaries and point spacing of bodies, as measures see them.
/// Cells are the coarsest about points of the bodies; with `surface` the finest, for points that
/// were gathered so.
MeasureContext measure_context(const Simulation& sim, const std::vector<int>& bodies,
                               bool surface = false);

/// The same for a measure, with what its partner gave.
MeasureContext context_of(const Simulation& sim, const MeasureOptions& measure);

/// What is wanted of points beside position, mass and density.
struct GatherNeeds {
  bool velocity = false, pieces = false;  ///< pieces: the velocity, and what is rubble
  /// Where the body ends: points among coarser cells stand for those that they would be split into
  /// in the finest ones of their bodies.
  bool surface = false;
  std::vector<std::string> fields{};  ///< scalars; those that not all bodies carry are left out,
                                      ///< but for "failed" (0 where a body cannot fail)
};

/// The points of bodies into `out`, body after body, patch after patch.
void gather_points(const Simulation& sim, const std::vector<int>& bodies, const GatherNeeds& needs,
                   BodyPoints& out);
/// The same into memory of its own.
BodyPoints gather_points(const Simulation& sim, const std::vector<int>& bodies,
                         const GatherNeeds& needs);

/// Number of every point's piece in its body (0 the heaviest), points in the order of their ids.
std::vector<double> fragment_numbers(const Simulation& sim, int body);

/// Selected points, gathered once for all measures of one selection.
class Selections {
 public:
  /// By which measures: of all, or of those in rows of history.
  enum class Asked { all, rows };

  explicit Selections(const Scene& scene);
  Selections(const Selections&) = delete;
  Selections& operator=(const Selections&) = delete;
  ~Selections();
  /// The points have moved: what was selected is memory only. `survey`: of all sets now, for a row;
  /// null: none was made.
  void begin(Asked asked, const std::vector<PointSurvey>* survey = nullptr);
  const BodyPoints& points(const Simulation& sim, const MeasureSelection& selection);

 private:
  struct Kept;
  bool gathers_layers(const Simulation& sim, const MeasureSelection& selection) const;

  std::map<std::vector<int>, GatherNeeds> needs_, in_rows_;  ///< by the bodies of a selection
  std::map<std::vector<int>, bool> layers_;  ///< the rows look at layers of these bodies only
  Asked asked_ = Asked::all;
  const std::vector<PointSurvey>* survey_ = nullptr;
  std::deque<Kept> kept_;  // references stay valid
};

/// A row of its history, or its summary, reads single points: its measures do, but for those of
/// impulses, or what looks for torn points.
bool looks_at_points(const Scene& scene);
/// Gauges and outcomes do so at times of their own.
bool looks_on_its_own(const Scene& scene);
/// A frame of it shows what depends on other points: fragments, torn points.
bool draws_all_points(const Scene& scene);

class Measurements {
 public:
  /// Of a simulation at its start: before a checkpoint is restored.
  explicit Measurements(const Simulation& sim);

  /// Throws InputError for what cannot be measured.
  void check(const Simulation& sim) const;
  /// Names and units of the columns of history.
  std::vector<Quantity> titles(const Scene& scene) const;
  /// Measures by their numbers, without what they remember: of deceleration the mean velocity, of
  /// force the impulse.
  std::vector<double> now(const Simulation& sim, const std::vector<int>& measures);
  /// Columns of the next row of history. Remembers it. `survey`: of the points as they are.
  std::vector<Quantity> row(const Simulation& sim, const std::vector<PointSurvey>& survey);
  /// "measures": value, unit, definition, reference and difference; "fragments": lists of pieces.
  void summarize(const Simulation& sim, Json& summary);

  /// Names of the measures that selected no point in the last summary.
  const std::vector<std::string>& without_points() const { return nothing_; }

  void save(Checkpoint& checkpoint, const Scene& scene) const;
  /// Measures that the checkpoint does not know, or that have `changed` since, start here.
  void restore(const Checkpoint& checkpoint, const Scene& scene,
               const std::vector<std::string>& changed);

 private:
  /// `survey`: of those in rows; null: of all measures.
  std::vector<double> values(const Simulation& sim, const std::vector<PointSurvey>* survey);
  double sample(const Simulation& sim, std::size_t i);  ///< now, without what is remembered

  Selections selections_;
  std::vector<MeasureStart> start_;    ///< by measure
  std::vector<MeasureSeries> series_;  ///< by measure
  std::vector<std::string> nothing_;
};

}  // namespace krater
