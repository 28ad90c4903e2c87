// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/simulation/body.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "krater/core/errors.hpp"
#include "krater/geometry/seeds/thickness.hpp"
#include "krater/kinematics/mesh/mesh_step.hpp"
#include "krater/kinematics/mpm/columns.hpp"
#include "krater/kinematics/sph/sph_step.hpp"
#include "krater/materials/catalogue.hpp"
#include "krater/points/load_fields.hpp"
#include "krater/simulation/material_plan.hpp"

namespace krater {

namespace {

// Shear modulus over bulk modulus up to which a solid is soft: its strength does not hold the
// points against what their quadrature makes of the pressure.
constexpr double kSoft = 0.01;

bool wants(const Scene& scene, const FieldInfo& field) {
  for (const std::string& name : scene.output.fields)
    if (name == field.name) return true;
  return false;
}

/// A gauge records strains of the body.
bool strained(const Scene& scene, int body) {
  return std::any_of(scene.gauges.begin(), scene.gauges.end(), [body](const GaugeOptions& gauge) {
    return gauge.body == body &&
           std::any_of(gauge.fields.begin(), gauge.fields.end(),
                       [](const std::string& name) { return name.starts_with(kStrain); });
  });
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
      layout_{dimension(scene.frame)},
      seed_cell_{scene.grid.cell} {
  const MethodOptions& method = scene.method;
  if (options_->rigid()) {
    declare_rigid_points(method, material_->density, layout_);
    return;
  }
  if (!options_->material_points() && !options_->becomes_points()) {
    if (options_->mesh)
      declare_elements(material_->density, layout_);
    else
      declare_particles(material_->density, !loads_of(scene, index).empty(), layout_);
    if (wants(scene, field::DeformationGradient::info) || strained(scene, index))
      layout_.state<field::DeformationGradient>(0, "output");
  } else {
    const bool keeps_reference =
        scene.body_force != nullptr || wants(scene, field::ReferencePosition::info);
    declare_points(
        method,
        {.density = material_->density,
         .loaded = scene.body_force != nullptr,
         .face_loads = !loads_of(scene, index).empty(),
         .walls = has_wall(scene),
         .reference_position = wants(scene, field::ReferencePosition::info),
         .deformation = wants(scene, field::DeformationGradient::info) || strained(scene, index) ||
                        (keeps_reference && method.numerical_fracture == NumericalFracture::split),
         .domain =
             options_->material_points() && method.numerical_fracture != NumericalFracture::ignore},
        layout_);
  }
  add_stages(factory);
  if (options_->mesh) declare_element_results(layout_);
  if (options_->sph) declare_particle_results(layout_);
  if (options_->material_points() || options_->becomes_points())
    declare_results(heat_floor_ != nullptr, pressure_on_grid(scene), layout_);
  layout_.check();
  const Column* c = layout_.find(field::SoundSpeed::info.name);
  const double bulk = c == nullptr ? 0 : c->initial;
  sound_speed_ = std::sqrt(bulk * bulk + 4.0 / 3.0 * material_->shear_modulus / material_->density);
}

bool Body::pressure_on_grid(const Scene& scene) const {
  const Column* c = layout_.find(field::SoundSpeed::info.name);
  if (c == nullptr || !options_->material_points() || scene.method.reference != Reference::current)
    return false;
  return scene.method.grid_pressure == GridPressure::all ||
         (scene.method.grid_pressure == GridPressure::fluids && is_fluid());
}

double Body::signal_speed(double bulk) const {
  const double shear = 4.0 / 3.0 * material_->shear_modulus / material_->density,
               speed = std::max(sound_speed_, std::sqrt(bulk * bulk + shear));
  return speed * std::max(std::sqrt(2.0), q_lin_ + std::sqrt(1 + q_lin_ * q_lin_));
}

bool Body::is_fluid() const {
  const Column* c = layout_.find(field::SoundSpeed::info.name);
  if (c == nullptr) return false;
  const double bulk = material_->density * c->initial * c->initial;
  const bool solid = material_->strength || material_->model;
  return !solid || material_->shear_modulus < kSoft * bulk;
}

void Body::add_stages(const StageFactory& factory) {
  const MaterialPlan plan = material_plan(*material_);
  q_lin_ = plan.q_lin;
  q_quad_ = plan.q_quad;
  degrades_ = degrades_stress(plan);
  stages_ = make_stages(factory, plan, layout_);
  for (const NamedStage& s : stages_) stage_pointers_.push_back(s.stage.get());
  const PlannedLaw& matter = plan.model.law >= 0 ? plan.model : plan.eos;
  if (matter.law >= 0)
    heat_floor_.reset(factory.heat_floor(matter.law, matter.values, plan.constants, layout_));
}

BodyKernelData Body::kernel_data() const {
  BodyKernelData data;
  data.columns = point_columns(layout_, material_->failure == FailureAction::remove);
  data.stages = stage_pointers_.data();
  data.heat_floor = heat_floor_.get();
  data.stage_count = static_cast<int>(stage_pointers_.size());
  return data;
}

int Body::slot(const FieldInfo& field, int component) const {
  const Column* c = layout_.find(field.name);
  return c == nullptr ? -1 : c->offset / kLanes + component;
}

std::vector<SeedPoint> Body::lattice(const Scene& scene, int level) {
  LatticeOptions lattice;
  lattice.cell = std::ldexp(scene.grid.cell, -level);
  lattice.points_per_direction = options_->points.per_direction;
  lattice.fit_to_body = options_->points.fit_to_body;
  lattice.origin = scene.grid.min;
  lattice.stagger = scene.method.stagger && !options_->sph;
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
  return out;
}

std::vector<SeedPoint> Body::seeds(const Scene& scene, int level) {
  std::vector<SeedPoint> out = lattice(scene, level);
  seed_moments_ = moments_of(out, scene.frame);
  seed_cell_ = std::ldexp(scene.grid.cell, -level);
  examine_thickness(scene, out, seed_cell_);
  return out;
}

/// One cell cannot bend, shear or show a wave: what it does is not the material's doing.
void Body::examine_thickness(const Scene& scene, const std::vector<SeedPoint>& seeds, double cell) {
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
  if (!options_->thin_allowed) require_thickness(cell);
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

}  // namespace krater
