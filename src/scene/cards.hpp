// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file scene/cards.hpp
/// Material cards: files that hold a material's block. `card: ofhc_copper` is
/// materials/ofhc_copper.yaml beside the scene, or inputs/materials/ofhc_copper.yaml there, in a
/// folder above it or in the current folder; `card: ../x.yaml` is a path from the scene's folder.
/// Keys of the scene stand over those of the card.
///
/// A card may also hold `damage` and `spall_strength`: effects that a scene must ask for. They are
/// used only where the scene's material names the key too: `damage: card` takes the card's,
/// `damage: {johnson_cook: {D1: 0.1}}` lays its own numbers over them.
#include <string>
#include <vector>

#include "scene/tree.hpp"

namespace krater::scene {

class Problems;

/// A material's block with its card, if it names one, laid under it.
struct CardedMaterial {
  Node block;
  std::vector<std::string> unused;  ///< keys that the card holds and the scene does not ask for
};
CardedMaterial with_card(const Node& material, const std::string& scene_file, Problems& problems);

}  // namespace krater::scene
