// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/mpm/domain.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace krater {

Triple longest_half(const DomainTensor& M) {
  const Eigen::SelfAdjointEigenSolver<DomainTensor> axes{M};
  const Eigen::Vector3d e = axes.eigenvectors().col(2);  // eigenvalues ascend
  int towards = 0;
  e.cwiseAbs().maxCoeff(&towards);
  const double half = std::copysign(std::sqrt(std::max(0.0, axes.eigenvalues()[2])), e[towards]);
  return {half * e[0], half * e[1], half * e[2]};
}

}  // namespace krater
