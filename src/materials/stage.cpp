// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/materials/stage.hpp"

namespace krater {

Stage::~Stage() = default;

}  // namespace krater
