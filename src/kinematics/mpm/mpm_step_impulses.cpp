// SPDX-License-Identifier: GPL-3.0-or-later
// The account of momentum in a step: what came from outside, and what watched partners gave.
#include "krater/kinematics/mpm/mpm_step.hpp"

namespace krater {

namespace {

void add(Triple& sum, const Triple& more) {
  for (std::size_t a = 0; a < 3; ++a) sum[a] += more[a];
}

}  // namespace

void MpmStep::book_loads(double dt) {
  const LoadWork work = loads_.work(dt);
  audit_.load_work += work.faces;
  audit_.damping_work += work.damping;
  audit_.step_external += work.faces + work.damping;
  add(audit_.load_impulse, work.face_impulse);
  add(audit_.damping_impulse, work.damping_impulse);
  add(external_impulse_, work.face_impulse);
  add(external_impulse_, work.damping_impulse);
}

void MpmStep::book_impulses() {
  add(external_impulse_, constraints_.contact.driven_impulse);
  add(audit_.external_impulse, external_impulse_);
  add(audit_.wall_impulse, constraints_.walls.impulse);
  add(audit_.wall_impulse, constraints_.contact.held_impulse);
}

void MpmStep::note_impulses() {
  contact_.give(impulses_);
  impulses_.add(boundary_.given());
}

/// Points that were put back, before the patches are sorted anew.
void MpmStep::note_put_back() {
  for (std::size_t p = 0; p < removed_.size(); ++p)
    for (int side = 0; side < 6 && removed_[p].reflections > 0; ++side)
      impulses_.book(grid_.patches()[p].field, Partner::side(side / 2, side % 2),
                     removed_[p].side_impulse[static_cast<std::size_t>(side)]);
}

}  // namespace krater
