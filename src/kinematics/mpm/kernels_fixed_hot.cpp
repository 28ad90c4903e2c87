// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/mpm/transfer_kernels.hpp"

namespace krater::inline KRATER_ISA {

Kernels* make_fixed_kernels(const KernelChoice& choice);
Kernels* make_fixed_kernels(const KernelChoice& choice) {
  switch (choice.frame) {
    case KernelFrame::axisymmetric:
      return make_transfer_kernels<Axisymmetric, FixedConfiguration>(choice.shape, choice.affine);
    case KernelFrame::plane:
      return make_transfer_kernels<Cartesian<2>, FixedConfiguration>(choice.shape, choice.affine);
    case KernelFrame::space:
      break;
  }
  return make_transfer_kernels<Cartesian<3>, FixedConfiguration>(choice.shape, choice.affine);
}

}  // namespace krater::inline KRATER_ISA
