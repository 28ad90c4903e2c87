// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file simulation/material_plan.hpp
/// From a material of the scene to what materials/assembly makes stages of: one translation, for
/// the bodies of a run and for `krater point`.
#include "krater/materials/assembly.hpp"
#include "krater/scene/scene.hpp"

namespace krater {

/// The plan points into `material`, which must outlive it.
MaterialPlan material_plan(const MaterialOptions& material);

}  // namespace krater
