// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file scene/yaml/cards.hpp
/// Material cards: files that hold a material's block. `card: ofhc_copper` is ofhc_copper.yaml,
/// looked for beside the scene and in its folder materials/, in the folders of $KRATER_CARDS, in
/// materials/ and inputs/materials/ of the folders above, in inputs/materials/ of the current
/// folder, and in the installation, which lies where the program does; `card: ../x.yaml` is a path
/// from the scene's folder. Keys of the scene stand over those of the card.
///
/// A card may also hold `damage` and `spall_strength`: effects that a scene must ask for. They are
/// used only where the scene's material names the key too: `damage: card` takes the card's,
/// `damage: {johnson_cook: {D1: 0.1}}` lays its own numbers over those of that law, and another law
/// replaces it.
///
/// `unsourced: [spall_strength, heating.plastic_work.cp]` in a card names the values that no source
/// was read for; `krater check` and `krater models` repeat them.
///
/// `card: {keywords: {file: steel.k, units: [g, mm, ms]}}` is read from cards of LS-DYNA
/// (scene/yaml/keyword_card.hpp).
///
/// `card: {concrete: {fc: 39 MPa, model: karagozian_case}}` (or cscm) is generated from a strength
/// instead of read: uncalibrated, and said so.
#include <string>
#include <vector>

#include "scene/yaml/tree.hpp"

namespace krater::scene {

class Problems;

/// A material's block with its card, if it names one, laid under it.
struct CardedMaterial {
  Node block;
  std::string file;                    ///< of the card
  std::vector<std::string> unused;     ///< keys that the card holds and the scene does not ask for
  std::vector<std::string> unsourced;  ///< of the card's values used: no source was read for them
};
/// A value as it would stand at another place of a file, for its messages.
Node placed(const Node& at, const std::string& path, Node value);
/// The block of a material generated from what stands in `card`; `path` is the material's.
Node generated_card(const Node& card, const std::string& path, Problems& problems);

CardedMaterial with_card(const Node& material, const std::string& scene_file, Problems& problems);

}  // namespace krater::scene
