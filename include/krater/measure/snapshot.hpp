// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file measure/snapshot.hpp
/// The simulation as arrays for people: fields in order of the points' ids, history rows, audit.
#include "krater/output/results.hpp"
#include "krater/simulation/simulation.hpp"

namespace krater {

/// Fields of all points: what the columns hold, plus stress and von Mises stress. Method internals
/// only on request.
OutputFrame make_frame(const Simulation& sim, int number);

/// Energies, work, momentum, events and bodies at this moment.
std::vector<Quantity> history_row(const Simulation& sim, const std::vector<PointSurvey>& survey);
inline std::vector<Quantity> history_row(const Simulation& sim) {
  return history_row(sim, sim.survey());
}

/// The audit (theory 11) as JSON.
Json audit_json(const Simulation& sim);

}  // namespace krater
