// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file output/checkpoint.hpp
/// checkpoint.h5: every blob under /state, their kinds and names in order in the text /order;
/// sealed (output/seal.hpp).
#include <string>

#include "krater/output/results.hpp"

namespace krater::output {

void save_checkpoint(const std::string& path, const Checkpoint& checkpoint,
                     const TextAttributes& attributes);

}  // namespace krater::output
