// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file scene/readers/read_axes.hpp
/// Axes, sides and faces by their names: `z`, `z_max`.
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/readers/readers.hpp"

namespace krater::scene {

/// The grid axis of a word, -1: none. In the half section the first axis is called r or x, so that
/// one scene serves both 2D frames.
int axis_of(Frame frame, std::string_view word);
std::vector<std::string> axis_names(Frame frame);
/// "z_max" -> axis and side; axis -1: none.
std::pair<int, int> side_of(Frame frame, std::string_view word);
std::string side_name(Frame frame, int axis, int side);
int read_axis(Block& block, Reading& reading);  ///< the key `axis`; -1 after a problem

}  // namespace krater::scene
