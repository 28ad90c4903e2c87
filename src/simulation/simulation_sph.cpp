// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of smoothed particles in a simulation.
#include "krater/core/errors.hpp"
#include "krater/kinematics/sph/sph_loads.hpp"
#include "krater/simulation/material_plan.hpp"
#include "krater/simulation/point_maker.hpp"
#include "krater/simulation/simulation.hpp"

namespace krater {

void Simulation::place_particles() {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    Body& body = *bodies_[b];
    if (!body.options().sph) continue;
    if (!sph_) {
      DomainSides domain{scene_.frame, scene_.grid.boundary, {}};
      for (std::size_t a = 0; a < 3; ++a)
        domain.planes[a] = {scene_.grid.min[a], scene_.grid.max[a]};
      sph_ = std::make_unique<SphStep>(domain, level_, audit_);
      sph_->set_loads(
          std::make_unique<SphLoads>(scene_.loads, body_force(), dimension(scene_.frame)));
    }
    const MaterialPlan plan = material_plan(body.material());
    SphBody made{.body = static_cast<int>(b),
                 .points = PointStore{body.layout().stride()},
                 .layout = &body.layout(),
                 .stages = kernel_data_[b].stages,
                 .stage_count = kernel_data_[b].stage_count,
                 .density = body.material().density,
                 .shear_modulus = body.material().shear_modulus,
                 .q_lin = plan.q_lin,
                 .q_quad = plan.q_quad,
                 .barotropic = kernel_data_[b].heat_floor == nullptr,
                 .options = *body.options().sph};
    PointMaker maker{scene_, static_cast<int>(b), body};
    const std::vector<SeedPoint> seeds = body.seeds(scene_);
    for (std::size_t id = 0; id < seeds.size(); ++id)
      made.points.append(maker.make(seeds[id], id).data());
    sph_->add(std::move(made));
  }
  if (sph_) sph_->start();
}

Totals Simulation::totals_of_particles(int s) const {
  Totals t;
  const PointSet particles = set(s);
  const Body& body = *bodies_[static_cast<std::size_t>(particles.body)];
  const int x = body.slot(field::Position::info), v = body.slot(field::Velocity::info),
            m = body.slot(field::Mass::info), e = body.slot(field::InternalEnergy::info);
  for (int i = 0; i < particles.count(); ++i) {
    const auto at = [&](int slot) { return particles.points->at(kLanes * slot, i); };
    const double mass = at(m);
    t.count += 1;
    t.mass += mass;
    for (int a = 0; a < geometry_.dimension; ++a) {
      t.kinetic += 0.5 * mass * at(v + a) * at(v + a);
      t.momentum[static_cast<std::size_t>(a)] += mass * at(v + a);
    }
    t.internal += mass * at(e);
    t.angular_momentum += mass * (at(x) * at(v + 1) - at(x + 1) * at(v));
  }
  return t;
}

void Simulation::restore_particles(int b, const Checkpoint& checkpoint) {
  const Body& body = *bodies_[static_cast<std::size_t>(b)];
  const CheckpointBlob* points = checkpoint.find("bodies/" + body.name() + "/points");
  const CheckpointBlob* particles = checkpoint.find("bodies/" + body.name() + "/particles");
  if (points == nullptr || particles == nullptr)
    throw InputError("checkpoint: body '" + body.name() + "' has no particles there");
  const std::vector<int> sets = sets_of(b);
  restore_columns(*points, body, sets);
  for (const int s : sets) {
    if (!sph_->set_state(s - mesh_sets(), particles->doubles))
      throw InputError("checkpoint: body '" + body.name() + "' has other particles there");
    sph_->pad(s - mesh_sets());
  }
  sph_->find_forces();
}

}  // namespace krater
