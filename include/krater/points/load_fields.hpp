// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file points/load_fields.hpp
/// Fields of loads on faces (kinematics/mpm/node_loads.hpp), as those of points/fields.hpp.
#include "krater/points/fields.hpp"

namespace krater::field {

struct LoadShare {
  static constexpr FieldInfo info{"load_share", "1", kPerAxis,
                                  "1 where the point belongs to the face of a load, one component "
                                  "per load of its body"};
};
struct LoadUnit {
  static constexpr FieldInfo info{"load_unit", "1", 1, "one: the pressure that measures areas"};
};

}  // namespace krater::field
