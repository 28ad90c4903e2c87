// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file simulation/rigid_course.hpp
/// Where the rigid bodies of a scene go if nothing pushes them, as far as that can be known before
/// the run. A rigid body that runs into a closed side ends it (contact/rigid.hpp); of a prescribed
/// motion that is certain, of a free body it holds unless something stops it.
///
/// The motion is that of the run (RigidBody::begin, finish), in steps of at most a quarter of a
/// cell. Of a body's points those that reach furthest along 3^d - 1 directions are followed: all
/// are points of the body, so what is foreseen happens; of a body that turns it may happen a little
/// earlier. Bodies that travel more than kMostSteps quarters of a cell are followed no further.
#include <optional>
#include <string>
#include <vector>

#include "krater/simulation/simulation.hpp"

namespace krater {

struct SideCollision {
  int axis, side;  ///< side: 0 lower, 1 upper
  double time;     ///< [s], of the step in which it happens
};

/// The first of a rigid body, if any. Collective (core/ranks.hpp).
std::optional<SideCollision> foresee_collision(const Simulation& sim, const RigidBody& body);

/// Throws InputError where a prescribed motion ends in a closed side and the scene has no answer
/// (`time.stop_when`) that may end the run before.
void require_way(const Simulation& sim);

/// One sentence for each body that may come to a closed side.
std::vector<std::string> doubt_course(const Simulation& sim);

}  // namespace krater
