// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/load_changes.hpp"

#include <algorithm>

#include "krater/core/parallel.hpp"

namespace krater {

namespace {
constexpr std::size_t kChunk = 512;  // masses
}

void LoadChanges::push(const Masses& masses, const Acceleration& body_force, double damping,
                       double time, double dt) {
  const double half = 0.5 * damping * dt;
  const auto dim = static_cast<std::size_t>(masses.dimension);
  if (body_force)  // one after the other: an expression has one place for its variables
    for (std::size_t n = 0; n < masses.count; ++n) {
      const LoadedMass m = masses.at(n);
      const Triple push = body_force(m.x, m.X, time);
      for (std::size_t a = 0; a < dim; ++a) given_[kGiven * n + 6 + a] = dt * push[a];
    }
  for_each((masses.count + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    for (std::size_t n = chunk * kChunk; n < std::min((chunk + 1) * kChunk, masses.count); ++n) {
      const LoadedMass m = masses.at(n);
      double* given = given_.data() + kGiven * n;
      if (!(m.mass > 0)) continue;
      for (std::size_t a = 0; a < dim; ++a) {
        m.change[a] += given[6 + a];
        given[3 + a] = -half * (2 * m.v[a] + m.change[a]) / (1 + half);
        m.change[a] += given[3 + a];
      }
    }
  });
}

Triple LoadChanges::book(const Masses& masses, Audit& audit) const {
  std::array<double, 3> work{};
  std::array<Triple, 3> impulse{};
  for (std::size_t n = 0; n < masses.count; ++n) {
    const LoadedMass m = masses.at(n);
    const double* given = given_.data() + kGiven * n;
    for (std::size_t kind = 0; kind < 3; ++kind)
      for (std::size_t a = 0; a < 3; ++a) {
        const double J = m.mass * given[3 * kind + a];
        work[kind] += J * (m.v[a] + 0.5 * m.change[a]);
        impulse[kind][a] += J;
      }
  }
  audit.load_work += work[0];
  audit.damping_work += work[1];
  audit.external_work += work[0] + work[1] + work[2];
  Triple all{};
  for (std::size_t a = 0; a < 3; ++a) {
    audit.load_impulse[a] += impulse[0][a];
    audit.damping_impulse[a] += impulse[1][a];
    all[a] = impulse[0][a] + impulse[1][a] + impulse[2][a];
    audit.external_impulse[a] += all[a];
  }
  return all;
}

}  // namespace krater
