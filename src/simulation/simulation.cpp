// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/simulation/simulation.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "krater/core/errors.hpp"
#include "krater/core/parallel.hpp"
#include "krater/core/ranks.hpp"
#include "krater/kinematics/mpm/columns.hpp"
#include "krater/simulation/face_loads.hpp"
#include "krater/simulation/refinement.hpp"
#include "krater/simulation/rigid_course.hpp"
#include "simulation/slabs.hpp"

namespace krater {

namespace {

GridGeometry make_geometry(const Scene& scene) {
  GridGeometry g;
  g.dimension = dimension(scene.frame);
  g.h = scene.grid.cell;
  g.inv_h = 1 / scene.grid.cell;
  for (int a = 0; a < g.dimension; ++a) {
    const auto i = static_cast<std::size_t>(a);
    g.min[i] = scene.grid.min[i];
    g.cells[i] =
        static_cast<int>(std::lround((scene.grid.max[i] - scene.grid.min[i]) / scene.grid.cell));
  }
  return g;
}

KernelFrame kernel_frame(Frame f) {
  switch (f) {
    case Frame::axisymmetric:
      return KernelFrame::axisymmetric;
    case Frame::plane_strain:
      return KernelFrame::plane;
    case Frame::cartesian_3d:
      break;
  }
  return KernelFrame::space;
}

KernelShape kernel_shape(Shape s) {
  switch (s) {
    case Shape::linear:
      return KernelShape::linear;
    case Shape::gimp:
      return KernelShape::gimp;
    case Shape::quadratic_bspline:
      break;
  }
  return KernelShape::quadratic_bspline;
}

/// Of the limit that theory 12 derives for B-splines; measured on the same free block. Elements
/// have a limit of their own (kinematics/mesh/element.hpp), which is sharp.
double stable_share(const Scene& scene) {
  const MethodOptions& method = scene.method;
  for (const BodyOptions& body : scene.bodies)
    if (!body.material_points()) return 1;
  if (method.transfer == Transfer::xpic) return 0.6;  // its filter feeds back what it takes
  return method.shape == Shape::gimp && method.update == Update::usl ? 0.8 : 1;
}

}  // namespace

void require_steps(const TimeOptions& time, double stable) {
  const std::string is = fmt::format(
      " is longer than the stable step of this scene, {:.3g} s (cfl times the cell over wave speed "
      "and "
      "twice the greatest speed)",
      stable);
  if (time.first_step > stable)
    throw InputError(fmt::format("{}: first_step, {:.3g} s,{}; leave it out for an automatic one",
                                 time.where, time.first_step, is));
  if (time.min_step > stable)
    throw InputError(fmt::format("{}: min_step, {:.3g} s,{}: the run would fail at once",
                                 time.where, time.min_step, is));
}

Simulation::Simulation(const Scene& scene, IsaLevel level)
    : scene_{scene},
      level_{level},
      geometry_{make_geometry(scene)},
      grid_{geometry_},
      boundary_{geometry_, scene.grid.boundary, scene.method.reference != Reference::current},
      contact_{geometry_, scene.grid.boundary, scene.frame == Frame::axisymmetric,
               scene.method.shape == Shape::linear && scene.method.reference == Reference::current,
               scene.contact},
      energy_watch_{boundary_},
      detonation_{scene},
      clock_{{stable_share(scene) * scene.time.cfl, scene.time.first_step, scene.time.min_step,
              scene.time.max_step}} {
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    bodies_.push_back(std::make_unique<Body>(scene, static_cast<int>(b), stage_factory(level)));
    kernel_data_.push_back(bodies_.back()->kernel_data());
  }
  const bool affine =
      scene.method.transfer == Transfer::tflip || scene.method.transfer == Transfer::apic;
  const auto make = kernel_factory(level).make;
  KernelChoice choice{kernel_frame(scene.frame), kernel_shape(scene.method.shape), affine,
                      scene.method.reference != Reference::current};
  kernels_.reset(make(choice));
  choice.affine = choice.fixed_reference;
  plain_kernels_.reset(make(choice));
  if (choice.fixed_reference && scene.contact.active)
    carrier_kernels_.reset(
        make({kernel_frame(scene.frame), KernelShape::quadratic_bspline, true, false}));
  if (choice.fixed_reference || scene.contact.active) {  // a velocity field for each body
    std::vector<FieldId> fields;
    for (int b = 0; b < static_cast<int>(bodies_.size()); ++b) fields.push_back(own_field(b));
    grid_.set_fields(std::move(fields));
  }
  if (scene.contact.active) grid_.keep_shadows();
  find_levels();
  watch_impulses();
  loads_ = make_loads();
  plan_ranks();
  step_ = std::make_unique<MpmStep>(
      scene.method, MpmStep::Parts{grid_, boundary_, contact_, rigid_, *kernels_, *plain_kernels_,
                                   kernel_data_, audit_, *loads_, impulses_, carrier_kernels_.get(),
                                   kernel_shape(scene.method.shape), ranks_.get()});
  add_rigid_bodies();
  place_points();
  if (!ranks_) start();
}

void Simulation::start() {
  place_rigid_bodies();
  require_way(*this);
  place_meshes();
  place_particles();
  require_faces(*this);
  let_bodies_meet();
  find_movers();
  choose_first_step();
  const Totals start = totals();
  audit_.kinetic = audit_.initial_kinetic = start.kinetic;
  audit_.internal = audit_.initial_internal = start.internal;
  audit_.unfelt_start = 0;
  for (std::size_t b = 0; b < kernel_data_.size(); ++b)
    if (kernel_data_[b].heat_floor == nullptr)
      audit_.unfelt_start += totals(static_cast<int>(b)).internal;
  audit_.unfelt = audit_.unfelt_start;
  audit_.peak_energy = audit_.energy();
}

std::unique_ptr<NodeLoads> Simulation::make_loads() {
  std::vector<LoadColumns> columns;
  std::vector<bool> rigid;
  for (const auto& body : bodies_) {
    columns.push_back(load_columns(body->layout()));
    rigid.push_back(body->options().rigid());
  }
  return std::make_unique<NodeLoads>(scene_.loads, grid_, kernel_data_, std::move(columns),
                                     std::move(rigid));
}

void Simulation::watch_impulses() {
  for (const MeasureOptions& m : scene_.measures)
    for (const Partner by : m.by) {
      for (const FieldId on : fields_of(m.selection.bodies)) impulses_.watch(on, by);
      if (by.kind == Partner::Kind::body)
        contact_.note_impulses();
      else
        boundary_.note_impulses();
    }
}

void Simulation::add_rigid_bodies() {
  std::vector<bool> rigid(bodies_.size()), fluid(bodies_.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    fluid[b] = bodies_[b]->is_fluid();
    rigid[b] = bodies_[b]->options().rigid();
    if (rigid[b]) rigid_.add(rigid_options(scene_, *bodies_[b], static_cast<int>(b)));
  }
  boundary_.set_rigid_fields(std::move(rigid));
  contact_.set_fluids(std::move(fluid));
}

void Simulation::place_rigid_bodies() {
  for (RigidBody& body : rigid_.all())
    body.place(grid_, kernel_data_[static_cast<std::size_t>(body.options().body)].columns, 0);
  rigid_.write_velocities(grid_, columns_of(kernel_data_));
}

void Simulation::find_movers() {
  if (mesh_) movers_.push_back(mesh_.get());
  if (sph_) movers_.push_back(sph_.get());
  const bool becomes_points = std::any_of(bodies_.begin(), bodies_.end(), [](const auto& body) {
    return body->options().becomes_points();
  });
  if (movers_.empty() || becomes_points || step_->set_count() > 0) movers_.push_back(step_.get());
}

void Simulation::find_limit() {
  limit_ = movers_.front()->limit();
  for (const Kinematics* k : movers_)
    if (k->limit().rate > limit_.rate) limit_ = k->limit();
}

const char* Simulation::limiter() const {
  switch (limit_.kind) {
    case 0:
      return "wave speed";
    case 1:
      return "material velocity";
    default:
      return "volume change";
  }
}

std::string Simulation::describe_limit() const {
  const std::string text = fmt::format("limited by {}", limiter());
  if (limit_.body < 0) return text;  // at the start, with everything at rest
  for (const int n : sets_of(limit_.body)) {
    const int id = bodies_[static_cast<std::size_t>(limit_.body)]->slot(field::Id::info);
    for (int i = 0; i < set(n).count(); ++i)
      if (value(n, i, id) == limit_.id)
        return fmt::format("{} of {}{}", text, describe_point(n, i), limiting_field(n, i));
  }
  return text + " of a point that is gone";
}

std::string Simulation::limiting_field(int s, int point) const {
  const char* field = limit_.kind == 0   ? field::SoundSpeed::info.name
                      : limit_.kind == 1 ? field::Velocity::info.name
                                         : field::Density::info.name;
  const Column* column = bodies_[static_cast<std::size_t>(set(s).body)]->layout().find(field);
  std::string text;
  for (int k = 0; column != nullptr && k < column->components; ++k)
    text += fmt::format("{}{:.6g}", k == 0 ? fmt::format("; field '{}' is ", field) : ", ",
                        value(s, point, column->offset / kLanes + k));
  return text;
}

double Simulation::next_step(double until) {
  try {
    return clock_.next(std::max(limit_.rate, detonation_.rate(time())), until);
  } catch (const StepVanished& e) {
    assemble_together();
    throw NumericalError(
        fmt::format("time step vanished: {:.3e} s < time.min_step = {:.3e} s; {}; time {:.6e} s, "
                    "step {}",
                    e.step, e.least, describe_limit(), time(), steps()));
  }
}

void Simulation::advance(double until) {
  release();
  surveyed_ = -1;
  const double asked = next_step(until);
  rigid_.set_time(time());
  if (boundary_.set_time(time())) step_->relink();
  loads_->set_time(time());
  if (mesh_) mesh_->set_time(time());
  if (sph_) sph_->set_time(time());
  const Triple on_points = scene_.body_force ? apply_body_force() : Triple{};
  const std::array<double, 3> wall_force = apply_point_walls(asked);
  look_in_step(asked);
  double taken = 0;
  try {
    taken = take_step(movers_, asked, encounter_.get());
  } catch (const StepFault& fault) {
    fail_fault(fault);
  } catch (const ElementFault& fault) {
    broken_ = true;
    throw NumericalError(describe_fault(fault.set, fault.fault));
  } catch (const ParticleFault& fault) {
    broken_ = true;
    throw NumericalError(describe_fault(mesh_sets() + fault.set, fault.fault));
  } catch (const EnergyError& e) {
    fail_energy(e);
  } catch (const NumericalError& e) {
    broken_ = true;
    step_->deliver_leavers();
    throw NumericalError(fmt::format("{}; time {:.6e} s, step {}", e.what(), time(), steps()));
  }
  audit_.book_body_force(on_points, taken);
  if (walls_act_on_points())
    audit_.book_point_walls(wall_force, taken, !scene_.body_force && !scene_.loads.any());
  clock_.advance(asked, taken, until);
  if (steps() % kRegridSteps == 0) fit_points();
  find_limit();
  if (mesh_) adopt_converted();
  try {
    energy_watch_.check(audit_, taken);
  } catch (const EnergyError& e) {
    fail_energy(e);
  }
  watch(*this, warnings_);
  judge_energy(done());
}

/// Blocks of cells to the rules of the scene, points to the cells.
void Simulation::fit_points() {
  if (refinement_ || scene_.grid.merge ||
      scene_.method.numerical_fracture == NumericalFracture::split)
    seen_.clear();
  if (refinement_ && refinement_->moves()) step_->regrid(refinement_->find(grid_, ranks_.get()));
  if (scene_.method.numerical_fracture == NumericalFracture::split) step_->split_stretched();
  if (scene_.grid.merge) step_->merge();
}

void Simulation::fail_fault(const StepFault& fault) {
  broken_ = true;
  assemble_together();
  const std::string text =
      ranks::first() ? describe_fault(first_points() + fault.patch, fault.fault) : "";
  release();
  step_->deliver_leavers();  // points under way between blocks belong to the last frame too
  throw NumericalError(text);
}

void Simulation::judge_energy(bool last) {
  try {
    EnergyWatch::check_error(audit_, scene_.time.energy_error, time(), last);
  } catch (const EnergyError& e) {  // the state is whole: its checkpoint may go on regardless
    assemble_together();
    throw NumericalError(fmt::format("{}; {}; time {:.6e} s, step {}", e.what(), describe_hottest(),
                                     time(), steps()));
  }
}

/// Names the point where the energy is.
void Simulation::fail_energy(const EnergyError& e) {
  broken_ = true;
  assemble_together();
  throw NumericalError(
      fmt::format("{}; {}; time {:.6e} s, step {}", e.what(), describe_hottest(), time(), steps()));
}

bool Simulation::walls_act_on_points() const {
  return scene_.method.reference != Reference::current && has_wall(scene_);
}

std::array<double, 3> Simulation::apply_point_walls(double dt) {
  if (!walls_act_on_points()) return {};
  if (!scene_.body_force)
    for (Patch& patch : grid_.patches()) {
      const PointColumns& c = kernel_data_[static_cast<std::size_t>(patch.body)].columns;
      for (int i = 0; i < patch.points.count(); ++i)
        for (int a = 0; a < geometry_.dimension; ++a)
          patch.points.at(c.body_acceleration + kLanes * a, i) = 0;
    }
  const double spacing = geometry_.h / scene_.method.points_per_direction;
  return push_from_walls(grid_, kernel_data_, boundary_, spacing, dt);
}

Acceleration Simulation::body_force() const {
  if (!scene_.body_force) return {};
  return
      [this](const Triple& x, const Triple& X, double t) { return (*scene_.body_force)(x, X, t); };
}

Triple Simulation::apply_body_force() {
  std::array<ReproducibleSum, 3> force;
  const Acceleration load = body_force();
  for (RigidBody& body : rigid_.all())
    load_rigid(body, grid_, kernel_data_[static_cast<std::size_t>(body.options().body)].columns,
               load, time());
  for (Patch& patch : grid_.patches()) {
    if (rigid_.find(patch.body)) continue;
    const auto b = static_cast<std::size_t>(patch.body);
    const Column* reference = bodies_[b]->layout().find(field::ReferencePosition::info.name);
    const Triple more = accelerate(patch.points, kernel_data_[b].columns, reference->offset,
                                   geometry_.dimension, load, time());
    for (std::size_t a = 0; a < 3; ++a) force[a] += more[a];
  }
  ranks::sum(force);
  return {force[0].value(), force[1].value(), force[2].value()};
}

}  // namespace krater
