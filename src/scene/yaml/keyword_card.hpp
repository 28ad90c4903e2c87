// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file scene/yaml/keyword_card.hpp
/// Material cards of LS-DYNA: `card: {keywords: {file: steel.k, units: [g, mm, ms]}}`. Read are
/// *MAT_JOHNSON_COOK (015), *MAT_SIMPLIFIED_JOHNSON_COOK (098), *MAT_HIGH_EXPLOSIVE_BURN (008),
/// *EOS_GRUNEISEN and *EOS_JWL, in fields of ten columns or parted by commas. Reference: LS-DYNA
/// Keyword User's Manual, volume II. Assumptions: units are those asked for, mass, length, time
/// (the file states none), temperatures are K; D3 is the exponent of the triaxiality, tension
/// positive, as decks have it; one material and one equation of state stand in the file. What the
/// laws here do not know (a rate form, more than a linear Hugoniot) is an error, not passed over.
#include "scene/yaml/tree.hpp"

namespace krater::scene {

class Problems;

/// The block that the file makes of a material, empty after a problem. `node` is the value of
/// `keywords`; a file's path is relative to the scene's folder.
Node keyword_card(const Node& node, const std::string& scene_file, Problems& problems);

}  // namespace krater::scene
