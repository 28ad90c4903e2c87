// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/simulation/detonation.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "krater/core/errors.hpp"
#include "krater/materials/catalogue.hpp"
#include "krater/simulation/body.hpp"

namespace krater {

Detonation::Detonation(const Scene& scene) : scene_{scene} {
  std::vector<Explosive> explosives;
  std::vector<int> of_body(scene.bodies.size(), -1);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const BodyOptions& body = scene.bodies[b];
    const MaterialOptions& m = scene.materials[static_cast<std::size_t>(body.material)];
    if (body.rigid() || !m.eos) continue;
    const auto front = programmed_front(m.eos->law, m.eos->values.data(),
                                        {m.density, m.shear_modulus, m.initial_temperature});
    if (!front) continue;
    if (scene.detonators.empty())
      throw InputError(body.where +
                       ": nothing lights this explosive: add detonators: {NAME: {point: [0, 0]}}, "
                       "or let compression alone burn it (burn: compression of its eos), or start "
                       "it burnt (eos jwl)");
    of_body[b] = static_cast<int>(explosives.size());
    explosives.push_back({body.solid.get(), front->speed});
    burning_.push_back(front->width * scene.grid.cell / front->speed);
    rate_ = std::max(rate_, std::sqrt(2.0) * front->speed / scene.grid.cell);
  }
  if (explosives.empty()) {
    if (!scene.detonators.empty())
      throw InputError(scene.detonators[0].where +
                       ": there is no explosive to light: no body is made of a material with eos "
                       "jwl_burn");
    return;
  }
  constexpr double kSpacing = 0.5;  // of a cell
  explosives_ = std::move(of_body);
  lighting_ =
      std::make_unique<const Lighting>(scene.frame, domain_box(scene), kSpacing * scene.grid.cell,
                                       std::move(explosives), scene.detonators);
  for (const int d : lighting_->idle()) {
    const Detonator& idle = scene.detonators[static_cast<std::size_t>(d)];
    throw InputError(idle.where +
                     ": no explosive is within half a cell of it; move it into one, or remove it");
  }
}

double Detonation::since_lighting(int body, const Triple& x) {
  const int e = explosive(body);
  const double t = lighting_->at(e, x);
  if (!std::isfinite(t)) {
    missed_body_ = body;
    missed_ = x;
    return kNeverLit;
  }
  burnt_ = std::max(burnt_, t + burning_[static_cast<std::size_t>(e)]);
  return -t;
}

void Detonation::require_all_lit() const {
  if (missed_body_ < 0) return;
  throw InputError(fmt::format(
      "{}: no detonation reaches the explosive at ({:.4g}, {:.4g}, {:.4g}) m: no path through "
      "explosive leads there from any detonator; add a detonator for that part",
      scene_.bodies[static_cast<std::size_t>(missed_body_)].where, missed_[0], missed_[1],
      missed_[2]));
}

}  // namespace krater
