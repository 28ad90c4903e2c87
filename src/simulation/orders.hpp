// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file
/// What the first of several ranks tells the others to do (simulation_ranks.cpp).
#include <array>

#include "krater/core/ranks.hpp"

namespace krater {

enum class Order { leave, step, survey, assemble, restore, column, open_slabs, slab };

struct Told {
  Order order;
  double a, b;
};

/// The first says it, the others hear it: all call this.
inline Told tell(Order order, double a = 0, double b = 0) {
  std::array<double, 3> words{static_cast<double>(order), a, b};
  ranks::broadcast(words);
  return {static_cast<Order>(static_cast<int>(words[0])), words[1], words[2]};
}

}  // namespace krater
