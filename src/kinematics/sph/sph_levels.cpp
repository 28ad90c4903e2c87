// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/sph/sph_kernels.hpp"

namespace krater {

SphKernels::~SphKernels() = default;

const SphKernelFactory& sph_kernel_factory(IsaLevel level) {
#if defined(KRATER_HAVE_V4)
  if (level == IsaLevel::v4) return *sph_kernel_factory_isa_v4();
#endif
#if defined(KRATER_HAVE_V3)
  if (level == IsaLevel::v3) return *sph_kernel_factory_isa_v3();
#endif
  (void)level;
  return *sph_kernel_factory_isa_portable();
}

}  // namespace krater
