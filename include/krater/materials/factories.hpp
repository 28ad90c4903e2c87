// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The stage factories of the instruction-set levels; those the build has not compiled are not
/// defined (KRATER_HAVE_V3, KRATER_HAVE_V4).
#pragma once

#include "krater/materials/stage.hpp"

namespace krater {

const StageFactory* stage_factory_isa_portable();
const StageFactory* stage_factory_isa_v3();
const StageFactory* stage_factory_isa_v4();

}  // namespace krater
