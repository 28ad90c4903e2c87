// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/domain.hpp
/// Where the matter of a point lies (column `domain`): three times its second moment about the
/// point, per mass,
///   M_0 = diag a_i^2 (a box of half-widths a has the moments a^2/3),   M <- f M f^T,
/// so M = F M_0 F^T, and the roots of its eigenvalues are half the lengths of the matter along its
/// own axes, whichever way it has turned or sheared. It needs no F, which a law may keep for
/// itself. What is cut into parts of shares w at d from their centre, or made of them, has
///   M = sum w (M_k + 3 d_k d_k^T).
/// About an axis M is of the section.
#include <Eigen/Core>

#include "krater/contact/options.hpp"
#include "krater/points/columns.hpp"
#include "krater/points/store.hpp"

namespace krater {

/// M over the grid's axes; along others it is zero.
using DomainTensor = Eigen::Matrix3d;

/// Component of the column for the grid's axes a, b.
constexpr int domain_component(int dimension, int a, int b) {
  const int i = dimension == 2 ? 2 * a : a, j = dimension == 2 ? 2 * b : b;
  return i == j ? i : 6 - i - j;
}

/// `read(k)`: component k of the column.
template <class Read>
DomainTensor domain_tensor(int dimension, const Read& read) {
  DomainTensor out = DomainTensor::Zero();
  for (int a = 0; a < dimension; ++a)
    for (int b = 0; b < dimension; ++b) out(a, b) = read(domain_component(dimension, a, b));
  return out;
}
inline DomainTensor domain_of(const PointStore& points, const PointColumns& c, int dimension,
                              int i) {
  return domain_tensor(dimension, [&](int k) { return points.at(c.domain + kLanes * k, i); });
}

/// Half of the longest axis [m], towards the upper side of the grid axis that it is nearest to.
Triple longest_half(const DomainTensor& M);

/// No axis is longer than twice `half`, by a bound that needs no axes (Gershgorin).
inline bool surely_within(const DomainTensor& M, double half) {
  return M.cwiseAbs().rowwise().sum().maxCoeff() <= half * half;
}

}  // namespace krater
