// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/core/isa.hpp"
#include "krater/kinematics/mpm/kernel_levels.hpp"

namespace krater::inline KRATER_ISA {

Kernels* make_axisymmetric_kernels(KernelShape shape, bool affine);
Kernels* make_plane_kernels(KernelShape shape, bool affine);
Kernels* make_space_kernels(KernelShape shape, bool affine);
Kernels* make_fixed_kernels(const KernelChoice& choice);

namespace {

Kernels* make(const KernelChoice& choice) {
  if (choice.fixed_reference) return make_fixed_kernels(choice);
  switch (choice.frame) {
    case KernelFrame::axisymmetric:
      return make_axisymmetric_kernels(choice.shape, choice.affine);
    case KernelFrame::plane:
      return make_plane_kernels(choice.shape, choice.affine);
    case KernelFrame::space:
      break;
  }
  return make_space_kernels(choice.shape, choice.affine);
}

constexpr KernelFactory kFactory{make};

}  // namespace
}  // namespace krater::inline KRATER_ISA

namespace krater {
const KernelFactory* KRATER_CONCAT(kernel_factory_, KRATER_ISA)() { return &kFactory; }
}  // namespace krater
