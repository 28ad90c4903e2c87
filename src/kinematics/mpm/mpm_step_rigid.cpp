// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a step that only rigid bodies need.
#include "krater/kinematics/mpm/mpm_step.hpp"

namespace krater {

// Loads and drives act on rigid bodies when the length of the step is settled; their work is
// external.
void MpmStep::begin_rigid(double dt, double& kinetic) {
  if (!rigid_.any()) return;
  rigid_.rewind();  // of the question before, if there was one
  const Triple before = rigid_.momentum();
  const double work = rigid_.begin(dt);
  const Triple now = rigid_.momentum();
  for (std::size_t a = 0; a < 3; ++a) external_impulse_[a] += now[a] - before[a];
  kinetic += work;
  audit_.step_external += work;
}

// A turn keeps the angular momentum, not quite the energy; a rigid body has no heat to keep it in.
void MpmStep::finish_rigid(double dt) {
  const double before = rigid_.kinetic();
  rigid_.finish(dt);
  audit_.rigid_loss += before - rigid_.kinetic();
}

void MpmStep::move_rigid(std::size_t p, const SweepScratch& w) {
  Patch& patch = grid_.patches()[p];
  const PointColumns& columns = bodies_[static_cast<unsigned>(patch.body)].columns;
  removed_[p] = {};
  const bool moves = rigid_.find(patch.body)->moves();
  patch.tile.state = moves ? Tile::State::stale : Tile::State::asleep;
  if (!moves) return;
  rigid_.move(patch, grid_.levels(), boundary_, columns, w.leavers);
  name_limit(patch);
  removed_[p] = collect_leavers(patch, grid_.levels(), boundary_, columns, w.leavers);
}

// Bodies that leave through an open side; before the patches are sorted anew.
std::vector<int> MpmStep::rigid_losses() const {
  std::vector<int> out;
  for (const RigidBody& body : rigid_.all()) {
    double mass = 0;
    for (std::size_t p = 0; p < grid_.patches().size(); ++p)
      if (grid_.patches()[p].body == body.options().body) mass += removed_[p].mass;
    if (mass > 0) out.push_back(body.options().body);
  }
  return out;
}

}  // namespace krater
