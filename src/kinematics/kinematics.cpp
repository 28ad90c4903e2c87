// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/kinematics.hpp"

#include <algorithm>

namespace krater {

Kinematics::~Kinematics() = default;

double take_step(std::span<Kinematics* const> all, double dt) {
  double safe = dt;
  do {  // what one shortens, the others are asked again
    dt = safe;
    for (Kinematics* k : all) safe = std::min(safe, k->force(safe));
  } while (safe < dt && all.size() > 1);
  for (Kinematics* k : all) k->meet(safe);
  for (Kinematics* k : all) k->move(safe);
  return safe;
}

}  // namespace krater
