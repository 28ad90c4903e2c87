// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/mpm/columns.hpp"

#include "krater/points/ledger_fields.hpp"
#include "krater/points/load_fields.hpp"

namespace krater {

namespace {

constexpr const char* kMethod = "method";

bool carries_affine(Transfer t) { return t == Transfer::tflip || t == Transfer::apic; }

/// What every point has; its id lies at the head of the record.
void declare_body(double density, Layout& layout) {
  layout.state<field::Id>(0, kMethod);
  layout.state<field::Position>(0, kMethod);
  layout.state<field::Velocity>(0, kMethod);
  layout.state<field::Mass>(0, kMethod);
  layout.state<field::Density>(density, kMethod);
}

}  // namespace

void declare_points(const MethodOptions& m, const PointNeeds& needs, Layout& layout) {
  declare_body(needs.density, layout);
  if (carries_affine(m.transfer)) layout.state<field::AffineVelocity>(0, kMethod);
  if (m.shape == Shape::gimp) layout.state<field::HalfWidth>(0, kMethod);
  if (m.shape == Shape::gimp || needs.domain) layout.state<field::Domain>(0, kMethod);
  const bool fixed = m.reference != Reference::current;
  if (m.update == Update::musl || m.transfer == Transfer::xpic || fixed)
    layout.state<field::GridVelocity>(0, kMethod);
  if (m.cell_averaging) layout.state<field::ShockIndicator>(0, kMethod);
  if (fixed) {
    layout.state<field::ConfigurationPosition>(0, kMethod);
    layout.state<field::ConfigurationMap>(0, kMethod);
  }
  if (needs.loaded || (fixed && needs.walls)) layout.state<field::BodyAcceleration>(0, kMethod);
  if (needs.loaded || needs.reference_position) layout.state<field::ReferencePosition>(0, kMethod);
  if (needs.deformation) layout.state<field::DeformationGradient>(0, kMethod);
  if (needs.face_loads) {
    layout.state<field::LoadShare>(0, kMethod);
    layout.state<field::LoadUnit>(1, kMethod);
  }
  layout.local_output<field::StepGradient>(kMethod);
  layout.local_output<field::ExtraDilatation>(kMethod);
}

void declare_results(bool heat_floor, bool fluid, Layout& layout) {
  if (layout.optional<field::InternalEnergy>().offset < 0)
    layout.state<field::InternalEnergy>(0, kMethod);  // of the ledger
  if (heat_floor) layout.state<field::CarriedEnergy>(0, kMethod);
  if (fluid) layout.local_output<field::DilatationCorrection>(kMethod);
  layout.local_input<field::SignalSpeed>(kMethod);
  layout.local_input<field::DilatationRate>(kMethod);
}

void declare_rigid_points(const MethodOptions& m, double density, Layout& layout) {
  declare_body(density, layout);
  layout.state<field::ReferencePosition>(0, kMethod);
  if (m.shape == Shape::gimp) layout.state<field::HalfWidth>(0, kMethod);
}

LoadColumns load_columns(const Layout& layout) {
  return {layout.optional<field::LoadShare>().offset, layout.optional<field::LoadUnit>().offset};
}

PointColumns point_columns(const Layout& layout, bool removes) {
  PointColumns c;
  const auto state = [&]<class F>(F) { return layout.optional<F>().offset; };
  const auto local = [&]<class F>(F) { return layout.local_optional<F>().offset; };
  c.stride = layout.stride();
  c.local_stride = layout.local_stride();
  c.position = state(field::Position{});
  c.grid_position = state(field::ConfigurationPosition{});
  if (c.grid_position < 0) c.grid_position = c.position;
  c.reference = state(field::ReferencePosition{});
  c.map = state(field::ConfigurationMap{});
  c.velocity = state(field::Velocity{});
  c.mass = state(field::Mass{});
  c.density = state(field::Density{});
  c.affine = state(field::AffineVelocity{});
  c.stress = state(field::DeviatoricStress{});
  c.pressure = state(field::Pressure{});
  c.viscous = state(field::ViscousPressure{});
  c.energy = state(field::InternalEnergy{});
  c.carried = state(field::CarriedEnergy{});
  c.sound_speed = state(field::SoundSpeed{});
  c.indicator = state(field::ShockIndicator{});
  c.half_width = state(field::HalfWidth{});
  c.domain = state(field::Domain{});
  c.deformation = state(field::DeformationGradient{});
  c.failed = state(field::Failed{});
  if (removes) c.removed = c.failed;
  c.body_acceleration = state(field::BodyAcceleration{});
  c.grid_velocity = state(field::GridVelocity{});
  c.local_gradient = local(field::StepGradient{});
  c.local_dilatation = local(field::ExtraDilatation{});
  c.local_correction = local(field::DilatationCorrection{});
  c.local_heat = local(field::AvailableHeat{});
  c.local_signal = local(field::SignalSpeed{});
  c.local_rate = local(field::DilatationRate{});
  return c;
}

}  // namespace krater
