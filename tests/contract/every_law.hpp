// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Every law of a family with its typical parameters, and lanes to compare one point with eight.
#pragma once

#include <cstdint>

#include "krater/materials/law_list.hpp"
#include "material_support.hpp"

namespace krater::test {

template <class Law>
Law typical() {
  const int index = find_law(kFamilyNames[static_cast<int>(Law::family)], Law::name);
  const auto values = typical_parameters(catalogue().at(static_cast<std::size_t>(index)));
  return make_law<Law>(values.data(), kCopper);
}

/// Calls `check(law)` for every law of a family.
template <class Check, class... Laws>
void for_each_law(LawList<Laws...>, Family family, Check check) {
  const auto one = [&]<class Law>(const Law* law) {
    if (Law::family == family) check(*law);
  };
  const auto all = [&](const Laws&... laws) { (one(&laws), ...); };
  all(typical<Laws>()...);
}

/// Lane i of a pack made from eight doubles.
struct Lanes {
  alignas(64) double v[8];
  Pack pack() const { return load(v); }
};
inline bool same(double a, double b) {
  return __builtin_bit_cast(std::uint64_t, a) == __builtin_bit_cast(std::uint64_t, b);
}

}  // namespace krater::test
