// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of elements in a simulation.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "krater/core/errors.hpp"
#include "krater/kinematics/mesh/mesh_contact.hpp"
#include "krater/kinematics/mesh/mesh_loads.hpp"
#include "krater/kinematics/mpm/migrate.hpp"
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
      mesh_->set_loads(std::make_unique<MeshLoads>(scene_.loads, body_force(), scene_.frame));
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
                     .refresh_strain = body.options().mesh->refresh_strain,
                     .erosion = body.options().mesh->erosion,
                     .points = {}};
    if (body.options().becomes_points())
      made.points = {kernel_data_[b].columns,
                     body.layout().optional<field::ReferencePosition>().offset, geometry_.h,
                     Support::moment * geometry_.h * geometry_.h};
    made.velocities = velocities_of(body.options(), made.mesh);
    mesh_->add(std::move(made));
    if (!body.options().becomes_points()) continue;
    const PointSet elements = mesh_->set(mesh_->set_count() - 1);
    for (int i = 0; i < elements.count(); ++i)
      step_->expect_mass(elements.points->at(kernel_data_[b].columns.mass, i) / kPartsOfElement);
  }
  if (!mesh_) return;
  mesh_->start();
  health_ = mesh_->health();
}

/// Contact of bodies that are not all of points.
void Simulation::let_bodies_meet() {
  if (!scene_.contact.active || (!mesh_ && !sph_)) return;
  double fastest = 0;
  for (const auto& body : bodies_) fastest = std::max(fastest, body->initial_sound_speed());
  if (!sph_) {
    encounter_ = std::make_unique<MeshContact>(
        scene_.frame, scene_.contact,
        MeshContact::Parts{*mesh_, grid_, contact_, boundary_, rigid_, audit_, impulses_, fastest});
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
                           impulses_, fastest, true}));
  encounter_ = std::move(contact);
}

void Simulation::look_for_torn_points() {
  if (scene_.method.numerical_fracture == NumericalFracture::ignore) return;
  torn_ = krater::look_for_torn_points(*this);
  watch_points(*this, warnings_);
}

void Simulation::look_at_elements() {
  if (!mesh_) return;
  health_ = mesh_->health();
  audit_.most_folded = std::max(audit_.most_folded, static_cast<double>(health_.folded));
  watch_elements(*this, warnings_);
}

void Simulation::adopt_converted() {
  const std::vector<ConvertedPoints> all = mesh_->take_converted();
  if (all.empty()) return;
  for (const ConvertedPoints& points : all) {
    const auto b = static_cast<std::size_t>(points.body);
    const PointColumns& c = kernel_data_[b].columns;
    audit_.book_converted(points.heat, points.barotropic);
    const Removed gone = adopt(grid_, points.body, points.records, boundary_, c);
    audit_.book_removed(gone);
    if (points.barotropic) audit_.unfelt_removed += gone.internal;
    if (!loads_of(scene_, points.body).empty())
      warnings_.add("load_lost", time(),
                    fmt::format("elements of body '{}', on which loads act, became points: these "
                                "carry none, so the load ends where its faces convert",
                                bodies_[b]->name()));
    // Their own limit is known after their first step.
    const auto width = static_cast<std::size_t>(c.stride / kLanes);
    double fastest = 0, sound = 0;
    for (std::size_t k = 0; k < points.records.size(); k += width) {
      sound = std::max(sound, points.records[k + static_cast<std::size_t>(c.sound_speed / kLanes)]);
      for (int a = 0; a < geometry_.dimension; ++a)
        fastest = std::max(
            fastest,
            std::abs(points.records[k + static_cast<std::size_t>(c.velocity / kLanes + a)]));
    }
    const double rate = (2 * fastest + bodies_[b]->signal_speed(sound)) * geometry_.inv_h;
    if (rate > limit_.rate) limit_ = {rate, 1, points.body, points.records.front()};
  }
  grid_.rebuild(true);
  step_->relink();
}

void Simulation::look_for_overlap() {
  if (!mesh_) return;
  const MeshOverlap found = mesh_->overlap(geometry_.h);
  if (found.nodes == 0) return;
  std::string at;
  for (int a = 0; a < geometry_.dimension; ++a)
    at += fmt::format("{}{} = {:.4g} m", a > 0 ? ", " : "", axis_name(scene_.frame, a),
                      found.place[static_cast<std::size_t>(a)]);
  warnings_.add(
      "self_overlap", time(),
      fmt::format("body '{}' lies on itself, {} nodes of the grid are filled twice, most "
                  "about {}: elements have no contact with those of their own body; "
                  "kinematics: mpm has, or failure: {{action: convert}}",
                  bodies_[static_cast<std::size_t>(found.body)]->name(), found.nodes, at));
}

Totals Simulation::totals_of_mesh(int s) const {
  const NodeTotals nodes = mesh_->totals(s);
  return {1.0 * set(s).count(),      nodes.mass,     nodes.kinetic,
          mesh_->internal_energy(s), nodes.momentum, nodes.angular_momentum};
}

int Simulation::mesh_set(int body) const {
  int s = 0;
  while (mesh_->set(s).body != body) ++s;
  return s;
}

/// Room for its elements; `points`: those that elements became.
void Simulation::resize_mesh(int b, const Checkpoint& checkpoint, std::uint64_t points) {
  const std::string& name = bodies_[static_cast<std::size_t>(b)]->name();
  const CheckpointBlob* all = checkpoint.find("bodies/" + name + "/points");
  if (all == nullptr || all->shape.size() != 2 || all->shape[1] < points ||
      !mesh_->set_count(mesh_set(b), all->shape[1] - points))
    throw InputError("checkpoint: body '" + name + "' has another mesh there");
}

void Simulation::restore_mesh(int b, const Checkpoint& checkpoint) {
  const std::string& name = bodies_[static_cast<std::size_t>(b)]->name();
  const CheckpointBlob* mesh = checkpoint.find("bodies/" + name + "/mesh");
  if (mesh == nullptr || !mesh_->set_state(mesh_set(b), mesh->doubles))
    throw InputError("checkpoint: body '" + name + "' has another mesh there");
  mesh_->pad(mesh_set(b));
  mesh_->find_forces();
}

}  // namespace krater
