// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file app/version.hpp
#include <string>

namespace krater {

struct Version {
  std::string program, revision, compiler, build;
  std::string options;  ///< what it was built with: levels, optimisation, libraries
};
Version version();

}  // namespace krater
