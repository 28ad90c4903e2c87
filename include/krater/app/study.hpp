// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file app/study.hpp
/// `krater study` and `krater run --accuracy`: many runs of one scene. Both are a Python package
/// that lies with the program (tools/krater_study); its members are runs of this program, which so
/// stays the only reader of scenes.
#include <string>
#include <vector>

namespace krater {

/// Becomes `python3 krater_study WORDS...`; returns only by throwing InputError, where the package
/// or Python is missing.
int become_study(const std::vector<std::string>& words);

}  // namespace krater
