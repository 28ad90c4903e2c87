// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/app/thread_fit.hpp"

#include <algorithm>

#include "krater/core/parallel.hpp"

namespace krater {

namespace {

constexpr int kPatches = 2;  ///< per thread
constexpr int kEvery = 16;   ///< calls between two looks

/// Elements and particles share their work otherwise.
bool only_points(const Scene& scene) {
  return std::all_of(scene.bodies.begin(), scene.bodies.end(),
                     [](const BodyOptions& body) { return body.material_points(); });
}

int fitting(const Simulation& sim, int most) {
  const auto& patches = sim.grid().patches();
  const auto busy = std::count_if(patches.begin(), patches.end(), [](const Patch& patch) {
    return patch.count() > 0 && patch.tile.state != Tile::State::asleep;
  });
  return static_cast<int>(std::clamp<long>((busy + kPatches - 1) / kPatches, 1, most));
}

}  // namespace

ThreadFit::ThreadFit(int asked) : most_{asked > 0 ? 1 : threads()} {}

void ThreadFit::look(const Simulation& sim) {
  if (most_ == 1 || calls_++ % kEvery != 0) return;
  if (!only_points(sim.scene())) {
    most_ = 1;
    return;
  }
  const int now = threads(), fit = fitting(sim, most_);
  if (calls_ == 1 || fit >= 2 * now || 2 * fit <= now) set_threads(fit);
}

}  // namespace krater
