// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file contact/contact_regression.hpp
/// Normal of a contact by logistic regression (Nairn, Hammerquist, Smith 2020, CMAME 362, 112859):
/// the plane that best tells the volume of A from that of B within 1.5 cells of a node,
///   minimise  sum_p g_p ln(1 + exp(-y_p (w.xi_p + b))) + kRidge/2 |w|^2,
///   xi = (x_p - x_i)/h,  g_p = S_i(x_p) V_p / (the sum over the body),
/// y = -1 in A, +1 in B; n = w/|w|. The node is that of the joint: farther off one body is a tail
/// of few points. With the weights S_i the two lattices have the same mean place in the window,
/// whatever their phases; with equal ones the plane leant by up to 2 degrees, and a block that
/// slides without friction ploughed. For the same reason only points that face the other body
/// count, seen along the first guess: beyond a corner one body stands alone.
/// Newton's method, at most 15 iterations.
/// Exact for a plane joint of any tilt, where gradients of nodal volumes err by a few per cent;
/// costs a look at every point around every touching node.
#include <array>

#include "krater/grid/blocks.hpp"
#include "krater/points/columns.hpp"

namespace krater {

/// Improves `normal` (from A to B) at a node; leaves it where the bodies do not face each other to
/// both sides of it.
void regress_normal(const BlockGrid& grid, const std::vector<PointColumns>& columns, int body_a,
                    int body_b, const std::array<double, 3>& node, std::array<double, 3>& normal);

}  // namespace krater
