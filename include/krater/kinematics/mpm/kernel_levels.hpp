// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/kernel_levels.hpp
/// The same kernels compiled for three instruction sets (core/isa_level.hpp).
#include "krater/core/isa_level.hpp"
#include "krater/kinematics/mpm/kernels.hpp"

namespace krater {

const KernelFactory* kernel_factory_isa_portable();
const KernelFactory* kernel_factory_isa_v3();  ///< AVX2 and FMA
const KernelFactory* kernel_factory_isa_v4();  ///< AVX-512

const KernelFactory& kernel_factory(IsaLevel level);
const StageFactory& stage_factory(IsaLevel level);

}  // namespace krater
