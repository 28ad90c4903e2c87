// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of elements in a simulation.
#include <algorithm>
#include <cmath>

#include "krater/core/errors.hpp"
#include "krater/kinematics/mesh/mesh_contact.hpp"
#include "krater/kinematics/sph/sph_contact.hpp"
#include "krater/simulation/material_plan.hpp"
#include "krater/simulation/simulation.hpp"

namespace krater {

namespace {

MeshFrame mesh_frame(Frame frame) {
  switch (frame) {
    case Frame::axisymmetric:
      return MeshFrame::axisymmetric;
    case Frame::plane_strain:
      return MeshFrame::plane;
    case Frame::cartesian_3d:
      break;
  }
  return MeshFrame::space;
}

/// The body's own mesh, or the block that it fills inside the domain.
Mesh mesh_of(const Scene& scene, const BodyOptions& body) {
  if (body.mesh->mesh) return *body.mesh->mesh;
  const int dim = dimension(scene.frame);
  const Box box = intersection(body.solid->extent(scene.frame), domain_box(scene), dim);
  return block_mesh(dim, box.min, box.max,
                    elements_along(scene.frame, box.min, box.max, body.mesh->element));
}

std::vector<Triple> velocities_of(const BodyOptions& body, const Mesh& mesh) {
  std::vector<Triple> out;
  for (const Triple& x : mesh.nodes) {
    out.push_back(body.velocity ? (*body.velocity)(x, x, 0) : Triple{});
    if (!std::isfinite(out.back()[0] + out.back()[1] + out.back()[2]))
      throw InputError(body.where + ": its velocity is not a number at a node");
  }
  return out;
}

}  // namespace

void Simulation::place_meshes() {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const Body& body = *bodies_[b];
    if (!body.options().mesh) continue;
    if (!mesh_) {
      mesh_kernels_.reset(mesh_kernel_factory(level_).make(mesh_frame(scene_.frame)));
      DomainSides domain{scene_.frame, scene_.grid.boundary, {}};
      for (std::size_t a = 0; a < 3; ++a)
        domain.planes[a] = {scene_.grid.min[a], scene_.grid.max[a]};
      mesh_ = std::make_unique<MeshStep>(domain, *mesh_kernels_, audit_);
      mesh_->set_impulses(impulses_, scene_.contact.active);
    }
    const MaterialPlan plan = material_plan(body.material());
    ElementBody made{.body = static_cast<int>(b),
                     .mesh = mesh_of(scene_, body.options()),
                     .velocities = {},
                     .layout = &body.layout(),
                     .stages = kernel_data_[b].stages,
                     .stage_count = kernel_data_[b].stage_count,
                     .density = body.material().density,
                     .shear_modulus = body.material().shear_modulus,
                     .q_lin = plan.q_lin,
                     .q_quad = plan.q_quad,
                     .barotropic = kernel_data_[b].heat_floor == nullptr,
                     .held = body.options().mesh->hourglass,
                     .reference = body.options().mesh->reference,
                     .erosion = body.options().mesh->erosion};
    made.velocities = velocities_of(body.options(), made.mesh);
    mesh_->add(std::move(made));
  }
  if (!mesh_) return;
  mesh_->start();
  health_ = mesh_->health();
}

/// Contact of bodies that are not all of points.
void Simulation::let_bodies_meet() {
  if (!scene_.contact.active || (!mesh_ && !sph_)) return;
  if (!sph_) {
    encounter_ = std::make_unique<MeshContact>(
        scene_.frame, scene_.contact,
        MeshContact::Parts{*mesh_, grid_, contact_, boundary_, rigid_, audit_, impulses_});
    return;
  }
  std::vector<bool> fluids;
  for (const auto& body : bodies_) fluids.push_back(body->is_fluid());
  auto contact = std::make_unique<SphContact>(
      scene_.contact, std::move(fluids),
      SphContact::Parts{*sph_, grid_, boundary_, rigid_, audit_, impulses_});
  if (mesh_)
    contact->set_meshes(std::make_unique<MeshContact>(
        scene_.frame, scene_.contact,
        MeshContact::Parts{*mesh_, contact->nodes(), contact->fillings(), boundary_, rigid_, audit_,
                           impulses_, true}));
  encounter_ = std::move(contact);
}

void Simulation::look_at_elements() {
  if (!mesh_) return;
  health_ = mesh_->health();
  audit_.most_folded = std::max(audit_.most_folded, static_cast<double>(health_.folded));
  watch_elements(*this, warnings_);
}

Totals Simulation::totals_of_mesh(int s) const {
  const NodeTotals nodes = mesh_->totals(s);
  return {1.0 * set(s).count(),      nodes.mass,     nodes.kinetic,
          mesh_->internal_energy(s), nodes.momentum, nodes.angular_momentum};
}

void Simulation::restore_mesh(int b, const Checkpoint& checkpoint) {
  const Body& body = *bodies_[static_cast<std::size_t>(b)];
  const CheckpointBlob* points = checkpoint.find("bodies/" + body.name() + "/points");
  const CheckpointBlob* mesh = checkpoint.find("bodies/" + body.name() + "/mesh");
  const std::vector<int> sets = sets_of(b);
  const InputError other{"checkpoint: body '" + body.name() + "' has another mesh there"};
  if (points == nullptr || mesh == nullptr || points->shape.size() != 2) throw other;
  for (const int s : sets)
    if (!mesh_->set_count(s, points->shape[1])) throw other;
  restore_columns(*points, body, sets);
  for (const int s : sets) {
    if (!mesh_->set_state(s, mesh->doubles)) throw other;
    mesh_->pad(s);
  }
  mesh_->find_forces();
}

}  // namespace krater
