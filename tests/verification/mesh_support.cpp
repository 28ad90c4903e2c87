// SPDX-License-Identifier: GPL-3.0-or-later
#include "verification/mesh_support.hpp"

#include <random>
#include <stdexcept>

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

std::string text_of(const std::string& frame, const std::string& velocity,
                    const std::string& more) {
  const bool space = frame == "3d";
  const std::string low = frame == "axisymmetric" ? "0, -9" : space ? "-9, -9, -9" : "-9, -9";
  const std::string shape = frame == "axisymmetric" ? "cylinder: {radius: 1, height: 1}"
                                                    : "box: {min: [0, 0, 0], max: [1, 1, 1]}";
  return "frame: " + frame + "\ngrid: {cell: 0.25, box: {min: [" + low + "], max: [" +
         (space ? "9, 9, 9" : "9, 9") +
         "]}}\ntime: {end: 1}\nmaterials: {matter: {density: 1, youngs_modulus: 1, poisson_ratio: "
         "0.3, eos: linear, strength: elastic" +
         more + "}}\nbodies: {block: {material: matter, shape: {" + shape +
         "}, velocity: " + velocity + "}}\n";
}

Mesh shaken(Mesh mesh, double amplitude, unsigned seed) {
  std::mt19937 random{seed};
  std::uniform_real_distribution<double> move{-amplitude, amplitude};
  for (Triple& x : mesh.nodes)
    for (std::size_t a = 0; a < static_cast<std::size_t>(mesh.dimension); ++a) x[a] += move(random);
  return mesh;
}

void set_velocities(MeshRun& run, const std::vector<Triple>& v) {
  std::vector<double> state = run.mesh().state(0);
  for (std::size_t n = 0; n < v.size(); ++n)
    for (std::size_t a = 0; a < 3; ++a) state[8 * n + 4 + a] = v[n][a];
  if (!run.mesh().set_state(0, state)) throw std::logic_error("another mesh");
  run.mesh().find_forces();
}

}  // namespace krater::test
