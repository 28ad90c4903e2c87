// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/energy_error.hpp
/// The largest part of what is not physical (Audit::unphysical), by its name in history and
/// summary, and what would lower it.
#include <string>

#include "krater/kinematics/audit.hpp"

namespace krater {

/// "energy error 3.1 % of the 2400 J ...: most of it numerical_heat (+57 J), ...".
std::string describe_energy_error(const Audit& audit, double allowed);

}  // namespace krater
