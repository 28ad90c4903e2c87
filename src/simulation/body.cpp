// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/simulation/body.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "krater/core/errors.hpp"
#include "krater/geometry/seeds/thickness.hpp"
#include "krater/materials/catalogue.hpp"
#include "krater/points/ledger_fields.hpp"
#include "krater/simulation/material_plan.hpp"

namespace krater {

namespace {

constexpr const char* kMethod = "method";

// Shear modulus over bulk modulus up to which a solid is soft: its strength does not hold the
// points against what their quadrature makes of the pressure.
constexpr double kSoft = 0.01;

bool carries_affine(Transfer t) { return t == Transfer::tflip || t == Transfer::apic; }

bool wants(const Scene& scene, const FieldInfo& field) {
  for (const std::string& name : scene.output.fields)
    if (name == field.name) return true;
  return false;
}

/// Where the scene may be its own mirror image, across the axes before the last: at a symmetry side
/// of the domain, else in the middle of all bodies, else (where that is no border between columns
/// of points) in the middle of the domain.
std::array<double, 2> mirror_planes(const Scene& scene, const LatticeOptions& lattice) {
  std::array<double, 2> planes = lattice.mirror;
  for (int axis = 0; axis + 1 < dimension(scene.frame); ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double low = scene.grid.min[a], high = scene.grid.max[a];
    double first = high, last = low;
    for (const BodyOptions& body : scene.bodies) {
      const Box extent = body.solid->extent(scene.frame);
      first = std::min(first, std::max(extent.min[a], low));
      last = std::max(last, std::min(extent.max[a], high));
    }
    planes[a] = 0.5 * (first + last);
    const double column =
        (planes[a] - lattice.origin[a]) * lattice.points_per_direction[a] / lattice.cell;
    if (std::abs(column - std::round(column)) > 1e-6) planes[a] = 0.5 * (low + high);
    const auto& sides = scene.grid.boundary[a];
    if (sides[1].kind == BoundaryKind::symmetry) planes[a] = high;
    if (sides[0].kind == BoundaryKind::symmetry || scene.frame == Frame::axisymmetric)
      planes[a] = low;
  }
  return planes;
}

}  // namespace

bool has_wall(const Scene& scene) {
  for (int a = 0; a < dimension(scene.frame); ++a)
    for (const Boundary& side : scene.grid.boundary[static_cast<std::size_t>(a)])
      if (side.kind == BoundaryKind::wall) return true;
  return false;
}

Box domain_box(const Scene& scene) { return {scene.grid.min, scene.grid.max}; }

Body::Body(const Scene& scene, int index, const StageFactory& factory)
    : options_{&scene.bodies.at(static_cast<std::size_t>(index))},
      material_{&scene.materials.at(static_cast<std::size_t>(options_->material))},
      layout_{dimension(scene.frame)} {
  if (options_->rigid()) {
    declare_rigid_columns(scene);
    return;
  }
  declare_method_columns(scene);
  add_stages(factory);
  if (!layout_.find(field::InternalEnergy::info.name))
    layout_.state<field::InternalEnergy>(0, kMethod);  // of the ledger
  if (heat_floor_) layout_.state<field::CarriedEnergy>(0, kMethod);
  if (pressure_on_grid(scene)) layout_.local_output<field::DilatationCorrection>(kMethod);
  layout_.local_input<field::SignalSpeed>(kMethod);
  layout_.local_input<field::DilatationRate>(kMethod);
  layout_.check();
  const Column* c = layout_.find(field::SoundSpeed::info.name);
  const double bulk = c == nullptr ? 0 : c->initial;
  sound_speed_ = std::sqrt(bulk * bulk + 4.0 / 3.0 * material_->shear_modulus / material_->density);
}

void Body::declare_method_columns(const Scene& scene) {
  layout_.state<field::Id>(0, kMethod);
  layout_.state<field::Position>(0, kMethod);
  layout_.state<field::Velocity>(0, kMethod);
  layout_.state<field::Mass>(0, kMethod);
  layout_.state<field::Density>(material_->density, kMethod);
  const MethodOptions& m = scene.method;
  if (carries_affine(m.transfer)) layout_.state<field::AffineVelocity>(0, kMethod);
  if (m.shape == Shape::gimp) {
    layout_.state<field::HalfWidth>(0, kMethod);
    layout_.state<field::Domain>(0, kMethod);
  }
  if (m.update == Update::musl || m.transfer == Transfer::xpic || m.reference != Reference::current)
    layout_.state<field::GridVelocity>(0, kMethod);
  if (m.cell_averaging) layout_.state<field::ShockIndicator>(0, kMethod);
  if (m.reference != Reference::current) {
    layout_.state<field::ConfigurationPosition>(0, kMethod);
    layout_.state<field::ConfigurationMap>(0, kMethod);
    if (has_wall(scene)) layout_.state<field::BodyAcceleration>(0, kMethod);
  }
  if (scene.body_force) {
    layout_.state<field::BodyAcceleration>(0, kMethod);
    layout_.state<field::ReferencePosition>(0, kMethod);
  } else if (wants(scene, field::ReferencePosition::info)) {
    layout_.state<field::ReferencePosition>(0, kMethod);
  }
  if (wants(scene, field::DeformationGradient::info))
    layout_.state<field::DeformationGradient>(0, kMethod);
  layout_.local_output<field::StepGradient>(kMethod);
  layout_.local_output<field::ExtraDilatation>(kMethod);
}

bool Body::pressure_on_grid(const Scene& scene) const {
  const Column* c = layout_.find(field::SoundSpeed::info.name);
  if (c == nullptr || scene.method.reference != Reference::current) return false;
  if (scene.method.grid_pressure != GridPressure::fluids)
    return scene.method.grid_pressure == GridPressure::all;
  if (scene.contact.active) return false;  // a joint moves too much of a light node (src/README.md)
  const double bulk = material_->density * c->initial * c->initial;
  return !material_->strength || material_->shear_modulus < kSoft * bulk;
}

/// What the scatter and the motion as a whole need; no stress, no law.
void Body::declare_rigid_columns(const Scene& scene) {
  layout_.state<field::Id>(0, kMethod);
  layout_.state<field::Position>(0, kMethod);
  layout_.state<field::Velocity>(0, kMethod);
  layout_.state<field::Mass>(0, kMethod);
  layout_.state<field::Density>(material_->density, kMethod);
  layout_.state<field::ReferencePosition>(0, kMethod);
  if (scene.method.shape == Shape::gimp) layout_.state<field::HalfWidth>(0, kMethod);
}

void Body::add_stages(const StageFactory& factory) {
  const MaterialPlan plan = material_plan(*material_);
  q_lin_ = plan.q_lin;
  q_quad_ = plan.q_quad;
  degrades_ =
      plan.damage.law >= 0 && law_degrades(plan.damage.law, plan.damage.values, plan.constants);
  stages_ = make_stages(factory, plan, layout_);
  for (const NamedStage& s : stages_) stage_pointers_.push_back(s.stage.get());
  if (plan.eos.law >= 0)
    heat_floor_.reset(factory.heat_floor(plan.eos.law, plan.eos.values, plan.constants, layout_));
}

BodyKernelData Body::kernel_data() const {
  const auto state = [this](const FieldInfo& f) {
    const Column* c = layout_.find(f.name);
    return c == nullptr ? -1 : c->offset;
  };
  const auto local = [this](const FieldInfo& f) {
    for (const Column& c : layout_.locals())
      if (std::string_view{c.field->name} == f.name) return c.offset;
    return -1;
  };
  BodyKernelData data;
  PointColumns& c = data.columns;
  c.stride = layout_.stride();
  c.local_stride = layout_.local_stride();
  c.grid_position = state(field::ConfigurationPosition::info);
  c.map = state(field::ConfigurationMap::info);
  if (c.grid_position < 0) c.grid_position = state(field::Position::info);
  c.position = state(field::Position::info);
  c.velocity = state(field::Velocity::info);
  c.mass = state(field::Mass::info);
  c.density = state(field::Density::info);
  c.affine = state(field::AffineVelocity::info);
  c.stress = state(field::DeviatoricStress::info);
  c.pressure = state(field::Pressure::info);
  c.viscous = state(field::ViscousPressure::info);
  c.energy = state(field::InternalEnergy::info);
  c.carried = state(field::CarriedEnergy::info);
  c.sound_speed = state(field::SoundSpeed::info);
  c.indicator = state(field::ShockIndicator::info);
  c.half_width = state(field::HalfWidth::info);
  c.domain = state(field::Domain::info);
  c.deformation = state(field::DeformationGradient::info);
  c.failed = state(field::Failed::info);
  if (material_->failure == FailureAction::remove) c.removed = c.failed;
  c.body_acceleration = state(field::BodyAcceleration::info);
  c.grid_velocity = state(field::GridVelocity::info);
  c.local_gradient = local(field::StepGradient::info);
  c.local_dilatation = local(field::ExtraDilatation::info);
  c.local_correction = local(field::DilatationCorrection::info);
  c.local_heat = local(field::AvailableHeat::info);
  c.local_signal = local(field::SignalSpeed::info);
  c.local_rate = local(field::DilatationRate::info);
  data.stages = stage_pointers_.data();
  data.heat_floor = heat_floor_.get();
  data.stage_count = static_cast<int>(stage_pointers_.size());
  return data;
}

int Body::slot(const FieldInfo& field, int component) const {
  const Column* c = layout_.find(field.name);
  return c == nullptr ? -1 : c->offset / kLanes + component;
}

std::vector<SeedPoint> Body::seeds(const Scene& scene) {
  LatticeOptions lattice;
  lattice.cell = scene.grid.cell;
  lattice.points_per_direction = options_->points.per_direction;
  lattice.fit_to_body = options_->points.fit_to_body;
  lattice.origin = scene.grid.min;
  lattice.stagger = scene.method.stagger;
  lattice.mirror = mirror_planes(scene, lattice);
  lattice.mirror = mirror_planes(scene, lattice);
  lattice.jitter = options_->points.jitter;
  lattice.seed = options_->points.seed;
  std::vector<SeedPoint> out;
  try {
    out = fill_body(*options_->solid, scene.frame, lattice, options_->points.zones,
                    domain_box(scene), &fill_);
  } catch (const std::invalid_argument& e) {
    throw InputError(options_->where + ": " + e.what());
  }
  if (out.empty())
    throw InputError(
        options_->where +
        ": no part of this body lies inside the grid's box; move the body or enlarge grid.box");
  seed_moments_ = moments_of(out, scene.frame);
  examine_thickness(scene, out);
  return out;
}

/// One cell cannot bend, shear or show a wave: what it does is not the material's doing.
void Body::examine_thickness(const Scene& scene, const std::vector<SeedPoint>& seeds) {
  constexpr double kThinShare = 0.2, kToldShare = 0.05;
  MirrorSides mirrors{};
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t side = 0; side < 2; ++side)
      mirrors[a][side] = scene.grid.boundary[a][side].closed();
  const auto thickness = [&](double share) {
    return thickness_of_share(*options_->solid, scene.frame, seeds, domain_box(scene), mirrors,
                              share);
  };
  thickness_ = thickness(kToldShare);
  thin_ = thickness(kThinShare);
  if (!options_->thin_allowed) require_thickness(scene.grid.cell);
}

void Body::require_thickness(double cell) const {
  if (thin_ > cell * (1 + 1e-9)) return;
  throw InputError(fmt::format(
      "{}: a fifth of this body's mass or more lies where it is {:.3g} cells thick or less, and "
      "one "
      "cell cannot bend or shear: use grid.cell {:.2g} m or smaller, a thicker body, or say "
      "thin: allowed",
      options_->where, thin_ / cell, thin_ / 3));
}

void Body::make_point(const Scene& scene, const SeedPoint& seed, std::size_t id,
                      std::vector<double>& record) const {
  const int dim = dimension(scene.frame);
  record.assign(static_cast<std::size_t>(layout_.stride() / kLanes), 0.0);
  for (const Column& c : layout_.columns())
    for (int k = 0; k < c.components; ++k)
      record[static_cast<std::size_t>(c.offset / kLanes + k)] = c.initial;
  const auto set = [&](const FieldInfo& field, int component, double value) {
    const int at = slot(field, component);
    if (at >= 0) record[static_cast<std::size_t>(at)] = value;
  };
  set(field::Id::info, 0, static_cast<double>(id));
  set(field::Mass::info, 0, material_->density * seed.measure);
  const Triple velocity = options_->velocity ? (*options_->velocity)(seed.x, seed.x, 0) : Triple{};
  if (!std::isfinite(velocity[0] + velocity[1] + velocity[2]))
    throw InputError(fmt::format("{}.velocity is not finite at ({:.6g}, {:.6g}, {:.6g}) m",
                                 options_->where, seed.x[0], seed.x[1], seed.x[2]));
  for (int a = 0; a < dim; ++a) {
    const auto i = static_cast<std::size_t>(a);
    set(field::Position::info, a, seed.x[i]);
    set(field::ReferencePosition::info, a, seed.x[i]);
    set(field::ConfigurationPosition::info, a, seed.x[i]);
    set(field::ConfigurationMap::info, (dim + 1) * a, 1.0);
    set(field::Velocity::info, a, velocity[i]);
    set(field::GridVelocity::info, a, velocity[i]);
    set(field::HalfWidth::info, a, seed.half_width[i]);
    set(field::Domain::info, tensor_axis(scene.frame, a), seed.half_width[i] * seed.half_width[i]);
  }
  if (options_->velocity && carries_affine(scene.method.transfer)) {
    // The affine part holds part of a spinning body's angular momentum and energy: differences over
    // the point's own domain, exact for a linear field.
    for (int a = 0; a < dim; ++a) {
      const auto i = static_cast<std::size_t>(a);
      Triple low = seed.x, high = seed.x;
      low[i] -= seed.half_width[i];
      high[i] += seed.half_width[i];
      const Triple before = (*options_->velocity)(low, low, 0);
      const Triple after = (*options_->velocity)(high, high, 0);
      for (int k = 0; k < dim; ++k) {
        const auto j = static_cast<std::size_t>(k);
        set(field::AffineVelocity::info, dim * k + a, (after[j] - before[j]) / (high[i] - low[i]));
      }
    }
  }
  for (int k = 0; k < 9; k += 4) set(field::DeformationGradient::info, k, 1.0);
}

}  // namespace krater
