// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file contact/contact_regression.hpp
/// Normal of a contact by logistic regression (Nairn, Hammerquist, Smith 2020, CMAME 362, 112859):
/// the plane that best tells the points of A from those of B within 1.5 cells of a node,
///   minimise  sum_p ln(1 + exp(-y_p (w.xi_p + b))) + kRidge/2 |w|^2,   xi = (x_p - x_i)/h,
/// y = -1 in A, +1 in B; n = w/|w|. Only points that face the other body count, seen along the
/// first guess: beyond a corner one body stands alone, the plane would lean there by up to 14
/// degrees, and a block that slides without friction would plough. Newton's method, at most 15
/// iterations. Exact for a plane joint of any tilt, where gradients of nodal volumes err by a few
/// per cent; costs a look at every point around every touching node.
#include <array>

#include "krater/grid/blocks.hpp"
#include "krater/points/columns.hpp"

namespace krater {

/// Improves `normal` (from A to B) at a node; leaves it where there are too few points.
void regress_normal(const BlockGrid& grid, const std::vector<PointColumns>& columns, int body_a,
                    int body_b, const std::array<double, 3>& node, std::array<double, 3>& normal);

}  // namespace krater
