// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file points/ledger_fields.hpp
/// Fields of the energy ledger (kinematics/mpm/ledger.hpp), as those of points/fields.hpp.
#include "krater/points/fields.hpp"

namespace krater::field {

struct CarriedEnergy {
  static constexpr FieldInfo info{"carried_energy", "J/kg", 1,
                                  "heat taken by the ledger that the point could not give: a debt, "
                                  "negative, part of the internal energy"};
};
struct AvailableHeat {  // local
  static constexpr FieldInfo info{"available_heat", "J/kg", 1,
                                  "heat above absolute zero, which the ledger may take"};
};

}  // namespace krater::field
