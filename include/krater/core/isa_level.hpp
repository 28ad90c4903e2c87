// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file core/isa_level.hpp
/// The instruction sets that kernels are compiled for, and the choice between them at run time.

namespace krater {

enum class IsaLevel : int { portable, v3, v4 };
const char* name_of(IsaLevel level);

/// The best level this processor runs; KRATER_ISA=portable|v3|v4 in the environment lowers it (the
/// bits agree).
IsaLevel best_isa_level();

}  // namespace krater
