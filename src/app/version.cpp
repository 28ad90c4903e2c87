// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/app/version.hpp"

#include "krater/version_generated.hpp"

namespace krater {

Version version() {
  return {KRATER_VERSION, KRATER_GIT_REVISION, KRATER_COMPILER, KRATER_BUILD_TYPE,
          KRATER_BUILD_OPTIONS};
}

}  // namespace krater
