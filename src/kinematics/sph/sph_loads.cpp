// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/sph/sph_loads.hpp"

#include <algorithm>

#include "kinematics/sph/particles.hpp"

namespace krater {

namespace {

using Kind = FaceLoad::Kind;

double outwards(const FaceLoad& load) { return load.side == 0 ? -1 : 1; }

}  // namespace

std::vector<std::size_t> SphLoads::loads_of(int body) const {
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < options_.faces.size(); ++k) {
    const std::vector<int>& bodies = options_.faces[k].bodies;
    if (std::find(bodies.begin(), bodies.end(), body) != bodies.end()) out.push_back(k);
  }
  return out;
}

bool SphLoads::presses(int body) const {
  const std::vector<std::size_t> loads = loads_of(body);
  return std::any_of(loads.begin(), loads.end(),
                     [&](std::size_t k) { return options_.faces[k].kind != Kind::velocity; });
}

/// Force of a load on a particle that is whole in its face [N].
Triple SphLoads::push_of(const FaceLoad& load, const Triple& G) const {
  Triple f{};
  const auto value = [&](std::size_t a) { return load.value[a] ? load.value[a](time_) : 0; };
  if (load.axis < 0) {
    for (std::size_t a = 0; a < 3; ++a) f[a] = value(0) * G[a];
    return f;
  }
  const auto n = static_cast<std::size_t>(load.axis);
  if (load.kind == Kind::pressure) {
    f[n] = value(0) * G[n];
    return f;
  }
  for (std::size_t a = 0; a < 3; ++a) f[a] = -outwards(load) * value(a) * G[n];
  return f;
}

void SphLoads::add(SphStep::Particles& b, double dt) {
  if (!any()) return;
  const std::vector<std::size_t> loads = loads_of(b.made_of.body);
  LoadChanges& changes = changes_[&b];
  changes.begin(static_cast<std::size_t>(b.points.count()));
  const auto each = [&](bool velocities, const auto& act) {
    for (std::size_t k = 0; k < loads.size(); ++k) {
      const FaceLoad& load = options_.faces[loads[k]];
      if ((load.kind == Kind::velocity) != velocities) continue;
      for (int i = 0; i < b.points.count(); ++i)
        if (const double share = b.points.at(b.columns.share + kLanes * static_cast<int>(k), i);
            share > 0)
          act(load, i, share);
    }
  };
  each(false, [&](const FaceLoad& load, int i, double share) {
    const Triple f = push_of(load, b.area(i));
    for (std::size_t a = 0; a < static_cast<std::size_t>(dim_); ++a)
      changes.give(static_cast<std::size_t>(i), a, b.change(i),
                   dt * share * f[a] / b.points.at(b.columns.mass, i));
  });
  changes.push(masses(b), body_force_, options_.damping, time_, dt);
  each(true, [&](const FaceLoad& load, int i, double) {
    for (std::size_t a = 0; a < static_cast<std::size_t>(dim_); ++a) {
      if (!load.value[a]) continue;
      const double v = b.points.at(b.columns.velocity + kLanes * static_cast<int>(a), i);
      changes.give(static_cast<std::size_t>(i), a, b.change(i),
                   load.value[a](time_) - v - b.change(i)[a]);
    }
  });
}

LoadChanges::Masses SphLoads::masses(SphStep::Particles& b) const {
  return {static_cast<std::size_t>(b.points.count()), dim_, [this, &b](std::size_t n) {
            const int i = static_cast<int>(n);
            return LoadedMass{b.points.at(b.columns.mass, i), b.vector(b.columns.position, i, dim_),
                              b.start(i), b.vector(b.columns.velocity, i, dim_), b.change(i)};
          }};
}

Triple SphLoads::book(SphStep::Particles& b, Audit& audit) const {
  const auto at = changes_.find(&b);
  return at == changes_.end() ? Triple{} : at->second.book(masses(b), audit);
}

}  // namespace krater
