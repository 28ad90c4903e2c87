// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/mpm/kernel_levels.hpp"

#include "krater/materials/catalogue.hpp"

namespace krater {

Kernels::~Kernels() = default;

const KernelFactory& kernel_factory(IsaLevel level) {
#if defined(KRATER_HAVE_V4)
  if (level == IsaLevel::v4) return *kernel_factory_isa_v4();
#endif
#if defined(KRATER_HAVE_V3)
  if (level == IsaLevel::v3) return *kernel_factory_isa_v3();
#endif
  (void)level;
  return *kernel_factory_isa_portable();
}

const StageFactory& stage_factory(IsaLevel level) {
#if defined(KRATER_HAVE_V4)
  if (level == IsaLevel::v4) return *stage_factory_isa_v4();
#endif
#if defined(KRATER_HAVE_V3)
  if (level == IsaLevel::v3) return *stage_factory_isa_v3();
#endif
  (void)level;
  return *stage_factory_isa_portable();
}

}  // namespace krater
