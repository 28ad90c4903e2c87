// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file output/xdmf.hpp
/// XDMF 3 description of the frames: a temporal collection of frames, in each one Polyvertex grid
/// per body. Paths are relative to the folder of frames.xmf.
#include <map>
#include <string>

#include "krater/output/results.hpp"

namespace krater::output {

/// The <Grid> of one frame whose arrays are in `file`.
std::string frame_grid(const OutputFrame& frame, const std::string& file);

/// The whole document, from the <Grid> of every frame by number.
std::string xdmf_document(const std::map<int, std::string>& grids);

}  // namespace krater::output
