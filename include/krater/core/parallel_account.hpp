// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file core/parallel_account.hpp
/// Where a program's time goes as more threads see it: what is done inside for_each can be shared
/// by as many threads as there are items, the rest can not. For benchmarks; nothing is counted
/// unless asked for.
#include <cstddef>
#include <map>

namespace krater {

/// Calls of for_each by their number of items; work that few items keep on one thread counts as
/// one item.
struct ParallelAccount {
  struct Region {
    long long calls = 0;
    double seconds = 0;  ///< wall clock
  };
  std::map<std::size_t, Region> by_items;
};

/// From now on for_each keeps this account, which must outlive it; nullptr: none. Not for use while
/// for_each runs.
void keep_account(ParallelAccount* account);

}  // namespace krater
