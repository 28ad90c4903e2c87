// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file
/// What the two ways to tell the models share.
#include "krater/core/errors.hpp"
#include "krater/core/parameters.hpp"

namespace krater {

const char* range_text(Range r);

/// Neither a law nor a card has this name.
InputError no_such_model(const char* name);

}  // namespace krater
