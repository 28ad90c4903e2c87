// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file geometry/surfaces/file_text.hpp
/// Files of surfaces and meshes as a whole.
#include <string>

namespace krater {

/// All bytes of a plain file. Throws std::invalid_argument with the file's name and the reason.
std::string file_text(const std::string& file);

/// "stl" of "Part.STL".
std::string file_ending(const std::string& file);

}  // namespace krater
