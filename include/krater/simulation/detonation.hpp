// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file simulation/detonation.hpp
/// Programmed burn in a scene: which bodies are explosives that a front burns, when it reaches
/// their points (geometry/lighting.hpp), and the time step that follows it: less than a cell of
/// the front's way, though the unburnt matter before it knows slower waves only.
#include <memory>
#include <vector>

#include "krater/geometry/lighting.hpp"
#include "krater/scene/scene.hpp"

namespace krater {

class Detonation {
 public:
  /// Throws InputError where an explosive has no detonator, or a detonator no explosive.
  explicit Detonation(const Scene& scene);

  bool burns(int body) const { return explosive(body) >= 0; }
  /// Time since lighting, at the start of the run, of a point at x; negative before.
  double since_lighting(int body, const Triple& x);
  /// Throws InputError if the front does not come to all points. When all are placed.
  void require_all_lit() const;
  /// Rate of the signal that the front is [1/s]; 0 when all is burnt.
  double rate(double time) const { return time < burnt_ ? rate_ : 0; }

 private:
  int explosive(int body) const {
    return explosives_.empty() ? -1 : explosives_[static_cast<std::size_t>(body)];
  }

  const Scene& scene_;
  std::vector<int> explosives_;  ///< of each body in the lighting, -1: none; empty: no explosive
  std::vector<double> burning_;  ///< k h/D of each explosive [s]
  std::unique_ptr<const Lighting> lighting_;
  double rate_ = 0, burnt_ = -1;
  int missed_body_ = -1;
  Triple missed_{};
};

}  // namespace krater
