// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/kinematics.hpp"

#include <algorithm>

namespace krater {

Kinematics::~Kinematics() = default;
Encounter::~Encounter() = default;

double take_step(std::span<Kinematics* const> all, double dt, Encounter* between) {
  double safe = dt;
  do {  // what one shortens, the others are asked again
    dt = safe;
    for (Kinematics* k : all) safe = std::min(safe, k->force(safe));
  } while (safe < dt && all.size() > 1);
  if (between) between->push(safe);
  for (Kinematics* k : all) k->meet(safe);
  Standing standing = between ? between->book() : Standing{};
  for (Kinematics* k : all) standing = k->move(safe, standing);
  return safe;
}

}  // namespace krater
