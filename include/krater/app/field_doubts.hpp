// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file app/field_doubts.hpp
/// Bodies of one velocity field stick where they meet: a node has one velocity, that of the heavier
/// mass. A light material beside a much heavier one is then strained by a velocity gradient that is
/// not its own: air beside detonating TNT (1.2 and 1630 kg/m^3) reached 59 kg/m^3 where a shock
/// cannot take it beyond (gamma + 1)/(gamma - 1) 1.2 = 7.2; with a `contact:` block 9.3 (cells of 1
/// mm, plane blast after 20 us). A fluid in contact needs more points than a solid.
#include <string>
#include <vector>

#include "krater/scene/scene.hpp"

namespace krater {

/// One sentence per pair of materials whose densities differ more than tenfold in one field, and
/// per fluid in contact with less than four points per direction.
std::vector<std::string> doubt_fields(const Scene& scene);

/// One sentence per key of `method:` and of contact that was changed where every body has elements.
std::vector<std::string> doubt_method(const Scene& scene);

}  // namespace krater
