// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/mpm/transfer_kernels.hpp"

namespace krater::inline KRATER_ISA {

Kernels* make_plane_kernels(KernelShape shape, bool affine);
Kernels* make_plane_kernels(KernelShape shape, bool affine) {
  return make_transfer_kernels<Cartesian<2>, CurrentConfiguration>(shape, affine);
}

}  // namespace krater::inline KRATER_ISA
