// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/audit.hpp"

#include <algorithm>

namespace krater {

void Audit::book_step(const StepHeat& heat) {
  external_work += step_external;
  step_external = 0;
  transfer_loss += heat.given - heat.contact - heat.walls;
  transfer_gain += heat.taken;
  contact_heat += heat.contact;
  wall_heat += heat.walls;
  find_unfelt();
  carried = heat.carried;
  largest_carried = std::max(largest_carried, -carried);
  carriers += heat.carriers;
}

void Audit::book_events(const Ledger& ledger) {
  plastic_work += ledger.plastic_work;
  viscous_work += ledger.viscous_work;
  plastic_heating += ledger.plastic_heating;
  sound_speed_floors += ledger.sound_speed_floors;
  hugoniot_poles += ledger.hugoniot_poles;
  failures += ledger.failures;
  snap_backs += ledger.snap_backs;
  spalls += ledger.spalls;
}

void Audit::book_point_walls(const std::array<double, 3>& force, double dt, bool alone) {
  for (std::size_t a = 0; a < 3; ++a) wall_impulse[a] += force[a] * dt;
  if (!alone) return;
  wall_work += external_work;
  external_work = 0;
}

void Audit::book_removed(const Removed& gone) {
  kinetic -= gone.kinetic;
  internal -= gone.internal;
  removed_energy += gone.kinetic + gone.internal;
  removed_mass += gone.mass;
  removed_points += gone.count;
  removed_failed += gone.failed;
  for (std::size_t a = 0; a < 3; ++a) removed_momentum[a] += gone.momentum[a];
  reflections += gone.reflections;
  penetrations += gone.penetrations;
  deepest_reflection = std::max(deepest_reflection, gone.deepest);
  kinetic += gone.side_work;
  wall_work += gone.side_work;
  for (const std::array<double, 3>& impulse : gone.side_impulse)
    for (std::size_t a = 0; a < 3; ++a) wall_impulse[a] += impulse[a];
}

}  // namespace krater
