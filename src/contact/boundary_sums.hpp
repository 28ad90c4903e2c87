// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>

#include "krater/contact/boundary.hpp"
#include "krater/core/ranks.hpp"
#include "krater/core/reproducible_sum.hpp"

namespace krater {

struct BoundarySet::Sums {
  std::array<ReproducibleSum, 6> all;  ///< change, work, columns, impulse: BoundaryWork
};

}  // namespace krater
