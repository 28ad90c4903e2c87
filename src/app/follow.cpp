// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/follow.hpp"

#include <functional>

#include "krater/core/errors.hpp"
#include "krater/core/ranks.hpp"

namespace krater {

Readiness::~Readiness() {
  if (agreed_) return;
  const bool first_failed = ranks::max(ranks::first() ? 2 : 1) > 1;
  if (!first_failed) ranks::speak();
}

void Readiness::agree(const std::string& scene) {
  agreed_ = true;
  if (ranks::max(0) > 0) throw InputError("krater: another rank could not begin");
  const auto name = static_cast<double>(std::hash<std::string>{}(scene) >> 12U);  // exact
  if (ranks::max(name) != -ranks::max(-name))
    throw InputError(
        "krater: the ranks do not have the same scene: start all of them with the "
        "same file and the same --set");
}

}  // namespace krater
