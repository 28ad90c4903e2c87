// SPDX-License-Identifier: GPL-3.0-or-later
#include "verification/mesh_support.hpp"

#include "krater/kinematics/mpm/kernel_levels.hpp"
#include "krater/simulation/material_plan.hpp"

namespace krater::test {

namespace {

MeshFrame frame_of(Frame frame) {
  switch (frame) {
    case Frame::axisymmetric:
      return MeshFrame::axisymmetric;
    case Frame::plane_strain:
      return MeshFrame::plane;
    default:
      return MeshFrame::space;
  }
}

}  // namespace

MeshRun::MeshRun(const std::string& yaml, const Mesh& mesh, const Overrides& overrides,
                 const HourglassOptions& held, double cfl, ElementReference reference,
                 double refresh_strain)
    : scene_{read_text(yaml, overrides)},
      layout_{mesh.dimension},
      clock_{{cfl, scene_->time.first_step, 0, scene_->time.max_step}} {
  const BodyOptions& body = scene_->bodies.at(0);
  const MaterialOptions& material = scene_->materials.at(static_cast<std::size_t>(body.material));
  const MaterialPlan plan = material_plan(material);
  declare_elements(material.density, layout_);
  stages_ = make_stages(stage_factory(best_isa_level()), plan, layout_);
  declare_element_results(layout_);
  layout_.check();
  for (const NamedStage& s : stages_) pointers_.push_back(s.stage.get());
  kernels_.reset(mesh_kernel_factory(best_isa_level()).make(frame_of(scene_->frame)));

  DomainSides domain{scene_->frame, scene_->grid.boundary, {}};
  for (std::size_t a = 0; a < 3; ++a) domain.planes[a] = {scene_->grid.min[a], scene_->grid.max[a]};
  step_ = std::make_unique<MeshStep>(domain, *kernels_, audit_);
  ElementBody made{.body = 0,
                   .mesh = mesh,
                   .velocities = {},
                   .layout = &layout_,
                   .stages = pointers_.data(),
                   .stage_count = static_cast<int>(pointers_.size()),
                   .density = material.density,
                   .shear_modulus = material.shear_modulus,
                   .q_lin = plan.q_lin,
                   .q_quad = plan.q_quad,
                   .held = held,
                   .reference = reference,
                   .refresh_strain = refresh_strain,
                   .erosion = {},
                   .points = {}};
  for (const Triple& x : mesh.nodes)
    made.velocities.push_back(body.velocity ? (*body.velocity)(x, x, 0) : Triple{});
  step_->add(std::move(made));
  step_->start();
  clock_.start(step_->limit().rate);
}

void MeshRun::step(double until) {
  const double asked = clock_.next(step_->limit().rate, until);
  Kinematics* const all[] = {step_.get()};
  const double taken = take_step(all, asked);
  clock_.advance(asked, taken, until);
}

void MeshRun::run_to(double time) {
  while (clock_.time() < time) step(time);
}

std::vector<double> MeshRun::column(const FieldInfo& field, int component) const {
  std::vector<double> out;
  const Column* c = layout_.find(field.name);
  const PointSet set = step_->set(0);
  for (int i = 0; c != nullptr && i < set.count(); ++i)
    out.push_back(set.points->at(c->offset + kLanes * component, i));
  return out;
}

void MeshRun::set_column(const FieldInfo& field, int component, const std::vector<double>& values) {
  const Column* c = layout_.find(field.name);
  PointStore& store = step_->change(0);
  for (int i = 0; i < store.count(); ++i)
    store.at(c->offset + kLanes * component, i) = values[static_cast<std::size_t>(i)];
  step_->find_forces();
}

}  // namespace krater::test
