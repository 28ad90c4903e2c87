// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file points/fields.hpp
/// Every quantity a material point can carry, but for columns that one law alone knows: those stand
/// in its header (materials/law_state.hpp). A field is a type; its `info` gives name, unit,
/// components and meaning, so that output, restart, sorting and migration need no code per field.
///
/// Tensor components: `xx yy zz yz xz xy`, tension positive; pressure positive in compression. Grid
/// axes map to tensor axes by the frame: 3d (x, y, z) -> 0, 1, 2; plane strain (x, z) -> 0, 2 with
/// y = 1 out of plane; axisymmetric (r, z) -> 0, 2 with the hoop direction = 1.

namespace krater {

/// Number of components that depends on the dimension of the grid.
inline constexpr int kPerAxis = -1;         ///< one per grid axis (2 or 3)
inline constexpr int kPerAxisSquared = -2;  ///< a matrix over grid axes (4 or 9), row-major

struct FieldInfo {
  const char* name;
  const char* unit;
  int components;  ///< a positive number, kPerAxis or kPerAxisSquared
  const char* meaning;
};

/// Time since lighting of an explosive that nothing lights [s]: a step leaves it as it is.
inline constexpr double kNeverLit = -1e12;

template <class F>
concept Field = requires {
  static_cast<const FieldInfo&>(F::info);
};

namespace field {

#define KRATER_FIELD(Type, name, unit, components, meaning)           \
  struct Type {                                                       \
    static constexpr FieldInfo info{name, unit, components, meaning}; \
  }

// State: lives from step to step, is written to the checkpoint.
KRATER_FIELD(Id, "id", "1", 1, "number of the point in its body, for ever");
KRATER_FIELD(Position, "position", "m", kPerAxis, "position along the grid axes");
KRATER_FIELD(Velocity, "velocity", "m/s", kPerAxis, "velocity along the grid axes");
KRATER_FIELD(AffineVelocity, "affine_velocity", "1/s", kPerAxisSquared,
             "velocity gradient carried to the grid (TFLIP, APIC)");
KRATER_FIELD(Mass, "mass", "kg", 1,
             "mass (full revolution if axisymmetric, per metre of depth in plane strain)");
KRATER_FIELD(Density, "density", "kg/m^3", 1, "current density");
KRATER_FIELD(DeviatoricStress, "deviatoric_stress", "Pa", 6, "deviator of the Cauchy stress");
KRATER_FIELD(Pressure, "pressure", "Pa", 1, "pressure carried by the material, without viscosity");
KRATER_FIELD(ViscousPressure, "viscous_pressure", "Pa", 1, "artificial viscous pressure");
KRATER_FIELD(InternalEnergy, "internal_energy", "J/kg", 1, "specific internal energy");
KRATER_FIELD(Temperature, "temperature", "K", 1, "temperature");
KRATER_FIELD(PlasticStrain, "plastic_strain", "1", 1, "accumulated equivalent plastic strain");
KRATER_FIELD(
    VoidVolume, "void_volume", "m^3/kg", 1,
    "specific volume of voids opened by plastic flow; the equation of state does not see it");
KRATER_FIELD(Distension, "distension", "1", 1,
             "volume of the porous material over that of its solid: 1 without pores");
KRATER_FIELD(BurnFraction, "burn_fraction", "1", 1,
             "mass fraction of an explosive that has become products");
KRATER_FIELD(SinceLighting, "since_lighting", "s", 1,
             "time since the detonation front came by, negative before");
KRATER_FIELD(Damage, "damage", "1", 1, "damage phi: 0 sound, fails at phi_c");
KRATER_FIELD(Failed, "failed", "1", 1,
             "1 where the material has failed: no tension, no deviator but friction of rubble");
KRATER_FIELD(SoundSpeed, "sound_speed", "m/s", 1, "bulk sound speed of the last update, undamaged");
KRATER_FIELD(ShockIndicator, "shock_indicator", "1", 1,
             "|tr D| h / c of the last update: switches cell averaging off");
KRATER_FIELD(HalfWidth, "half_width", "m", kPerAxis, "half-width of the point's domain (gimp)");
KRATER_FIELD(Domain, "domain", "m^2", 6,
             "squares of the half-widths as a tensor that turns and stretches with the material");
KRATER_FIELD(DeformationGradient, "deformation_gradient", "1", 9,
             "F, row-major, from the start of the run");
KRATER_FIELD(ReferencePosition, "reference_position", "m", kPerAxis,
             "position at the start of the run");
KRATER_FIELD(ConfigurationPosition, "configuration_position", "m", kPerAxis,
             "position in the reference configuration that carries the weights");
KRATER_FIELD(ConfigurationMap, "configuration_map", "1", kPerAxisSquared,
             "F from the reference configuration to now, over grid axes");
KRATER_FIELD(BodyAcceleration, "body_acceleration", "m/s^2", kPerAxis, "body force per mass");
KRATER_FIELD(GridVelocity, "grid_velocity", "m/s", kPerAxis,
             "interpolated grid velocity of the step (musl, xpic)");

// Local: exists only while a batch of points is updated.
KRATER_FIELD(StepGradient, "step_gradient", "1", 9,
             "dt L over tensor axes, row-major; f = I + dt L maps the step");
KRATER_FIELD(ExtraDilatation, "extra_dilatation", "1", 1,
             "dt (cell-averaged - own) tr L, zero without averaging");
KRATER_FIELD(DilatationCorrection, "dilatation_correction", "1/s", 1,
             "what a fluid's pressure on the grid adds to tr L");
KRATER_FIELD(StrainStep, "strain_step", "1", 6,
             "sym H, H = (f - I)[(f + I)/2]^-1: strain increment of the step");
KRATER_FIELD(DilatationRate, "dilatation_rate", "1/s", 1,
             "tr D of the step, cell-averaged where averaging is on");
KRATER_FIELD(SpecificVolumes, "specific_volumes", "m^3/kg", 2, "v_n and v_n+1");
KRATER_FIELD(SpecificWork, "specific_work", "J/kg", 1,
             "work of deviator and viscosity in the step");
KRATER_FIELD(ShearModulus, "shear_modulus", "Pa", 1, "undamaged shear modulus of the step");
KRATER_FIELD(EffectivePressure, "effective_pressure", "Pa", 1,
             "pressure on the undamaged area at the start of the step");
KRATER_FIELD(OpenedVolume, "opened_volume", "m^3/kg", 1, "voids opened by the step's plastic flow");
KRATER_FIELD(TensionLimit, "tension_limit", "Pa", 1,
             "lowest pressure that the strength law lets the material carry");
KRATER_FIELD(PlasticWork, "plastic_work", "J/kg", 1, "q d / rho of the step");
KRATER_FIELD(EffectiveDeviator, "effective_deviator", "Pa", 6,
             "deviator on the undamaged area: the trial, then the end of the step");
KRATER_FIELD(EquivalentStress, "equivalent_stress", "Pa", 1, "effective q of the step");
KRATER_FIELD(PlasticIncrement, "plastic_increment", "1", 1, "plastic strain of the step");
KRATER_FIELD(DamageGrowth, "damage_growth", "1", 4,
             "d phi/d eps of the step, plastic strain where growth starts, phi_c, growth without "
             "plastic strain");
KRATER_FIELD(SnapBack, "snap_back", "1", 1, "1 where softening snapped back in the step");
KRATER_FIELD(CarriedLoss, "carried_loss", "1", 2,
             "1 - w of the pressure, in tension and in compression (theory 9)");
KRATER_FIELD(SignalSpeed, "signal_speed", "m/s", 1, "of the stiffest motion, theory 12");

#undef KRATER_FIELD

}  // namespace field
}  // namespace krater
