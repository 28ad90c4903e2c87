// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/energy_watch.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "krater/kinematics/energy_error.hpp"

namespace krater {

namespace {

/// A place where energy may come from nowhere, and what helps there.
struct Source {
  const char* name;
  double gain;  ///< [J]
  const char* remedy;
};

std::array<Source, 3> sources(const Audit& a) {
  return {{{"transfer between points and grid", -(a.transfer_loss + a.transfer_gain),
            "another method.transfer or method.update, a viscosity block, a smaller grid.cell"},
           {"heat of walls", -a.wall_heat,
            "a smaller time.cfl; a look at what meets the sides of grid.box"},
           {"heat of contact", -a.contact_heat,
            "a smaller time.cfl or grid.cell; a look at where bodies meet"}}};
}

Source largest(const Audit& audit) {
  const auto all = sources(audit);
  return *std::max_element(all.begin(), all.end(),
                           [](const Source& a, const Source& b) { return a.gain < b.gain; });
}

}  // namespace

double EnergyWatch::came_in(const Audit& a) const {
  return a.initial_kinetic + a.initial_internal + a.external_work +
         (boundary_.drives() ? a.wall_work : 0.0);
}

void EnergyWatch::check_nodes(const Audit& audit, double kinetic, const StepWork& work) const {
  const double in = came_in(audit) + work.external + (boundary_.drives() ? work.walls : 0.0);
  if (kinetic - in <= kMostGain * std::max(audit.peak_energy, in)) return;
  const Source source = largest(audit);
  throw EnergyError(fmt::format(
      "energy from nowhere: this step would give the grid {:.4g} J of kinetic energy where {:.4g} "
      "J came in; no point was touched; largest gain so far: {} ({:.4g} J); try {}",
      kinetic, in, source.name, source.gain, source.remedy));
}

void EnergyWatch::check(Audit& audit, double dt) const {
  for_each_entry(audit, [](const char* name, double value) {
    if (!std::isfinite(value))
      throw EnergyError(fmt::format("{} is {}: the account of the energy is broken", name, value));
  });
  const double in = came_in(audit), now = audit.energy();
  audit.peak_energy_time += audit.peak_energy * dt;  // what comes now has not been there
  audit.peak_energy = std::max(audit.peak_energy, in);
  const double most = kMostGain * audit.peak_energy;
  if (audit.internal < -std::max(most, kMostGain * audit.kinetic))
    throw EnergyError(fmt::format(
        "the internal energy is {:.4g} J where {:.4g} J came in: matter gives what it never had; "
        "try a smaller time.cfl, failure or spall for what is drawn out, another method.reference",
        audit.internal, in));
  if (std::max(now, audit.kinetic) - in <= most) {
    audit.peak_energy = std::max(audit.peak_energy, now);
    return;
  }
  const Source source = largest(audit);
  throw EnergyError(fmt::format(
      "energy from nowhere: kinetic + internal + removed = {:.4g} J, kinetic {:.4g} J, where "
      "{:.4g} "
      "J came in (greatest so far {:.4g} J); largest gain: {} ({:.4g} J); try {}",
      now, audit.kinetic, in, audit.peak_energy, source.name, source.gain, source.remedy));
}

void EnergyWatch::check_error(const Audit& audit, double allowed, double time, bool last) {
  if (allowed == 0 || audit.error_fraction() <= allowed) return;
  if (!last && audit.peak_energy_time < kSettled * audit.peak_energy * time) return;
  throw EnergyError(describe_energy_error(audit, allowed) +
                    "; time.energy_error: off, or a greater share, goes on regardless");
}

}  // namespace krater
