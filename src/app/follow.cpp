// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/follow.hpp"

#include "app/signals.hpp"
#include "krater/app/run.hpp"
#include "krater/core/errors.hpp"
#include "krater/core/ranks.hpp"
#include "krater/output/results.hpp"
#include "krater/simulation/simulation.hpp"

namespace krater {

Readiness::~Readiness() {
  if (agreed_) return;
  const bool first_failed = ranks::max(ranks::first() ? 2 : 1) > 1;
  if (!first_failed) ranks::speak();
}

void Readiness::agree() {
  agreed_ = true;
  if (ranks::max(0) > 0) throw InputError("krater: another rank could not begin");
}

int follow(const std::string& restart, const Scene& scene, Readiness& ready) {
  ignore_signals();  // the first rank hears them
  Simulation sim{scene};
  if (!restart.empty()) sim.restore(read_checkpoint(restart));
  ready.agree();
  sim.distribute();
  sim.follow();
  return kDone;
}

}  // namespace krater
