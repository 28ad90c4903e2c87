// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/contact/impulse_heat.hpp"

#include "krater/grid/blocks.hpp"

namespace krater {

ReproducibleSum ImpulseHeat::book() const {
  constexpr int velocity = 0, change = 4;  // [v+, m, dv, k]
  ReproducibleSum sum;
  std::size_t first = 0;
  for (const Loss& loss : losses_) {
    double heat = loss.outside, mass = 0;
    for (std::size_t i = first; i < loss.end; ++i) {
      const Pushed& p = pushed_[i];
      mass += p.mass;
      for (std::size_t a = 0; a < 3; ++a)
        heat -= p.mass * (p.node[velocity + a] - 0.5 * p.node[change + a]) * p.change[a];
    }
    if (mass > 0)
      for (std::size_t i = first; i < loss.end; ++i) pushed_[i].node[moved::work] += heat / mass;
    first = loss.end;
    if (loss.counted) sum += heat;
  }
  return sum;
}

}  // namespace krater
