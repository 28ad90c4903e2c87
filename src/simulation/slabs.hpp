// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file
/// Points of one body that several ranks have, for the first to write slab by slab in the order of
/// their ids. Ids stand in shelves of 4096; all know how many points are on each, so that the first
/// asks for the shelves that hold some rows and no rank ever holds more than these.
#include <utility>
#include <vector>

#include "krater/simulation/simulation.hpp"

namespace krater {

struct Simulation::Slabs {
  static constexpr double kShelf = 4096;
  int body = -1;
  std::vector<std::pair<double, std::pair<int, int>>> own;  ///< id, where it is, in order
  std::vector<std::size_t> starts;                          ///< row of the first point of a shelf
  PointStore brought;                                       ///< on the first rank
  std::vector<int> levels;                                  ///< of these
  std::size_t first = 0;                                    ///< row of the first of them
};

}  // namespace krater
