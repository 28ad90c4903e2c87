// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/kernel_levels.hpp
/// The same kernels compiled for three instruction sets, and the choice between them at run time.
#include "krater/kinematics/mpm/kernels.hpp"

namespace krater {

const KernelFactory* kernel_factory_isa_portable();
const KernelFactory* kernel_factory_isa_v3();  ///< AVX2 and FMA
const KernelFactory* kernel_factory_isa_v4();  ///< AVX-512

enum class IsaLevel : int { portable, v3, v4 };
const char* name_of(IsaLevel level);

/// The best level this processor runs; KRATER_ISA=portable|v3|v4 in the environment lowers it (the
/// bits agree).
IsaLevel best_isa_level();
const KernelFactory& kernel_factory(IsaLevel level);
const StageFactory& stage_factory(IsaLevel level);

}  // namespace krater
