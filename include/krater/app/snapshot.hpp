// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file app/snapshot.hpp
/// The simulation as arrays for people: fields in order of the points' ids, history rows, measures,
/// summary.
#include "krater/app/simulation.hpp"
#include "krater/output/results.hpp"

namespace krater {

/// Fields of all points: what the columns hold, plus stress and von Mises stress. Method internals
/// only on request.
OutputFrame make_frame(const Simulation& sim, int number);

/// One value per measure of the scene, in its order [SI].
std::vector<double> evaluate_measures(const Simulation& sim);

/// Energies, work, momentum, events, bodies and measures at this moment.
std::vector<Quantity> history_row(const Simulation& sim, const std::vector<double>& measures);

/// The audit (theory 11) as JSON.
Json audit_json(const Simulation& sim);
/// Measures with unit, reference and difference.
Json measures_json(const Simulation& sim, const std::vector<double>& values);
/// SI unit of a measure.
std::string measure_unit(const MeasureOptions& measure);

}  // namespace krater
