// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file
/// What the first of several ranks tells the others to do (simulation_ranks.cpp).
#include <array>
#include <functional>
#include <vector>

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

/// What each of the others has, to the first, by rank; nothing on the others.
inline std::vector<ranks::Message> to_first(const std::function<std::vector<double>()>& own) {
  if (!ranks::first()) return ranks::exchange({{0, own()}}, {});
  std::vector<int> from;
  for (int r = 1; r < ranks::count(); ++r) from.push_back(r);
  return ranks::exchange({}, from);
}

}  // namespace krater
