// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file scene/cards.hpp
/// Material cards: files that hold a material's block. `card: ofhc_copper` is
/// materials/ofhc_copper.yaml beside the scene, or inputs/materials/ofhc_copper.yaml there, in a
/// folder above it or in the current folder; `card: ../x.yaml` is a path from the scene's folder.
/// Keys of the scene stand over those of the card.
#include <string>

#include "scene/tree.hpp"

namespace krater::scene {

class Problems;

/// The material's block with its card, if it names one, laid under it.
Node with_card(const Node& material, const std::string& scene_file, Problems& problems);

}  // namespace krater::scene
