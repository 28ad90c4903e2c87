// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/audit.hpp"

#include <algorithm>

namespace krater {

void Audit::book_step(const StepEnergies& e, const Constraint& walls, const Constraint& contact) {
  const double correction = walls.correction + contact.correction;
  const double work =
      e.grid_after - e.grid_before + correction - step_external;  // of the internal forces
  transfer_in += e.kinetic - e.grid_before;
  internal_work += work;
  external_work += step_external;
  wall_work += walls.work - walls.correction;
  contact_work += contact.work - contact.correction;
  transfer_out += e.grid_after + walls.work + contact.work - kinetic;
  time_centring += -work - (internal - e.internal);
  step_external = 0;
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
  for (std::size_t a = 0; a < 3; ++a) wall_impulse[a] += gone.side_impulse[a];
}

}  // namespace krater
