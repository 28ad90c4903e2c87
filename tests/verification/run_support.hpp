// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Simulations run inside a test: from YAML text or an inputs file with overrides ("path=value" as
// --set takes them).
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "krater/points/fields.hpp"
#include "krater/scene/scene.hpp"
#include "krater/simulation/simulation.hpp"

namespace krater::test {

struct Run {
  std::unique_ptr<const Scene> scene;  ///< must not move: the simulation refers to it
  std::unique_ptr<Simulation> sim;
};

using Overrides = std::vector<std::string>;

/// A scene from text; tests judge energy for themselves.
std::unique_ptr<const Scene> read_text(const std::string& yaml, const Overrides& overrides = {});
Run start_text(const std::string& yaml, const Overrides& overrides = {},
               IsaLevel level = best_isa_level());
/// `name`: a file of inputs/, e.g. "taylor_copper.yaml".
Run start_input(const std::string& name, const Overrides& overrides = {},
                IsaLevel level = best_isa_level());

void run_to(Run& run, double time);  ///< ends exactly at `time` [s]
void run_steps(Run& run, int steps);

/// One component of a field, points in order of their id; empty when there is no such column.
std::vector<double> column(const Run& run, const FieldInfo& field, int component = 0, int body = 0);
void set_column(Run& run, const FieldInfo& field, int component, const std::vector<double>& values,
                int body = 0);

/// A state of its own, whatever the simulation does afterwards.
Checkpoint saved_state(const Simulation& sim);

/// Every bit of a run: clock, audit, patches in their order, all columns of all bodies.
std::vector<std::uint64_t> all_bits(const Simulation& sim);

/// Energy residual of the audit against a slow walk over the points [J].
double energy_residual(const Run& run);

/// Rows of a CSV file under
/// tests/data/, header first, quotes honoured, lines that begin with # skipped.
std::vector<std::vector<std::string>> read_table(const std::string& name);

/// Slope of log(error) over log(h) between the first and the last entry.
double observed_order(const std::vector<double>& h, const std::vector<double>& error);

}  // namespace krater::test
