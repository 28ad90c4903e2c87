// SPDX-License-Identifier: GPL-3.0-or-later
// Booleans of solids by set operations on their spans: no mesh is cut, nothing degenerates, any
// depth and any solids. `contains` of a difference takes the subtracted solid as open up to its
// boundary's membership, as the operations on spans do up to their ends.
#pragma once

#include <memory>
#include <vector>

#include "krater/geometry/solids/solid.hpp"

namespace krater {

enum class Boolean { unite, intersect, subtract };

/// Union or intersection of all operands; of `subtract`, the first without all others. Throws
/// std::invalid_argument for no operand, a null one, or an operation on fewer than two.
std::shared_ptr<const Solid> make_boolean(Boolean operation,
                                          std::vector<std::shared_ptr<const Solid>> operands);

}  // namespace krater
