// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/mesh/mesh_frame_kernels.hpp"

namespace krater::inline KRATER_ISA {

namespace {

MeshKernels* make(MeshFrame frame) {
  switch (frame) {
    case MeshFrame::axisymmetric:
      return new FrameMeshKernels<Axisymmetric>;
    case MeshFrame::plane:
      return new FrameMeshKernels<Cartesian<2>>;
    case MeshFrame::space:
      break;
  }
  return new FrameMeshKernels<Cartesian<3>>;
}

constexpr MeshKernelFactory kFactory{make};

}  // namespace
}  // namespace krater::inline KRATER_ISA

namespace krater {
const MeshKernelFactory* KRATER_CONCAT(mesh_kernel_factory_, KRATER_ISA)() { return &kFactory; }
}  // namespace krater
