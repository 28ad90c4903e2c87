// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file materials/stage.hpp
/// A material is an ordered list of stages (theory 4; the order is that of materials/assembly.hpp);
/// a scene assembles only the stages it calls for. A stage asks the layout for its fields when it
/// is made, and is then applied to batches: one virtual call per batch, never per point.
#include "krater/points/layout.hpp"

namespace krater {

struct BatchData;

class Stage {
 public:
  Stage() = default;
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;
  virtual ~Stage();  // defined in stage.cpp: an inline one would be compiled at every
                     // instruction-set level
  virtual void apply(const BatchData& batch) const = 0;
};

/// Constants of a material that its laws share.
struct MaterialConstants {
  double density;              ///< rho0 [kg/m^3]
  double shear_modulus;        ///< G [Pa], 0 for a fluid
  double initial_temperature;  ///< [K]
};

/// Objective rate of the deviator (theory 3, Decision 1).
enum class Rate : int { truesdell, truesdell_projected, jaumann, green_naghdi };
inline constexpr const char* kRateNames[] = {"truesdell", "truesdell_projected", "jaumann",
                                             "green_naghdi"};
/// How damage enters the yield condition (Decision 8).
enum class Coupling : int { effective, rate };
/// Which pressure damage degrades (Decision 6).
enum class DegradePressure : int { tension, none, all };

/// What becomes of a point that has failed: it loses deviator and tension and keeps its mass, or it
/// is taken out of the computation at the end of the step, with its mass, momentum and energy
/// booked.
enum class FailureAction : int { strength_loss, remove };

/// What happens where the tension reaches the spall strength: the point fails, and the material
/// parts there; or the tension is cut off at the strength for ever, a bound that parts nothing.
enum class SpallAction : int { fail, limit };

/// Can the points of a body fail, and does damage grow before?
enum class Integrity : int { sound, failing, damaged };
/// What stands between the pressure of the equation of state and the carried one: nothing; damage
/// or a limit of tension; a spall strength at which points fail.
enum class Tension : int { own, carried, parting };

/// The deviator's update in stages of its own (materials/assembly.hpp says in which order): where a
/// scene has damage, a spall that fails or a rate other than truesdell.
enum class Part : int { start, trial, flow_stress, plastic_return, rate_return, growth, carried };
struct PartRequest {
  Part part;
  int law = -1;  ///< of strength, or for growth of damage; trial and carried need none
  const double* values = nullptr;
  MaterialConstants constants;
  Rate rate = Rate::truesdell;
  Integrity integrity = Integrity::sound;
  bool degrades = false;  ///< the stress is (1 - phi) s~; otherwise phi only tells the failure
  DegradePressure degrade = DegradePressure::tension;
  bool dilates = false;  ///< plastic flow opens voids
};

/// An equation of state between points that may be damaged or spall.
struct EosRequest {
  int law = -1;
  const double* values = nullptr;
  MaterialConstants constants;
  Tension tension = Tension::own;
  double spall_strength = 0;  ///< [Pa], infinite: none; of no meaning where tension is own
  bool dilates = false;       ///< the strength keeps voids out of it, and limits the tension
};

/// `heating: energy`: the temperature of an equation of state (heating/internal_energy.hpp).
struct EnergyHeatingRequest {
  int eos = -1;
  const double* eos_values = nullptr;
  double c_v = 0;  ///< [J/(kg K)]
  MaterialConstants constants;
  bool carries = false;   ///< the carried pressure may not be that of the equation of state
  bool degrades = false;  ///< as of PartRequest
};

/// The stages that stand about those of the strength.
struct StagesAround {
  Stage* before = nullptr;
  Stage* after = nullptr;
};

/// Makes stages of one instruction-set level (materials/stages_hot.cpp is compiled once per level).
struct StageFactory {
  /// `law`: index in catalogue() (materials/catalogue.hpp), of a family but eos and damage; a model
  /// takes its elastic trial from parts. `values`: its parameters in declared order. Ownership
  /// passes to the caller.
  Stage* (*make)(int law, const double* values, const MaterialConstants& constants, Layout& layout);
  Stage* (*part)(const PartRequest& request, Layout& layout);
  Stage* (*eos)(const EosRequest& request, Layout& layout);
  Stage* (*energy_heating)(const EnergyHeatingRequest& request, Layout& layout);
  /// What the deviator loses where the solid of an equation of state has parted
  /// (materials/stages/cohesion_stage.hpp): the stages before and after those of the strength,
  /// both null where the law has no such end. Made when the strength's own stages are.
  StagesAround (*cohesion)(int eos, const double* values, const MaterialConstants& constants,
                           Layout& layout);
  /// What burns an explosive, before the stage of its equation of state and made after it; null
  /// where nothing burns.
  Stage* (*burn)(int eos, const double* values, const MaterialConstants& constants, Layout& layout);
  /// Heat that may be taken (materials/stages/heat_floor_stage.hpp); null where the pressure of the
  /// law does not know the energy.
  Stage* (*heat_floor)(int eos, const double* values, const MaterialConstants& constants,
                       Layout& layout);
  /// Always first: f -> sym H, rho, v, tr D, and F where it `keeps_F`.
  Stage* (*kinematics)(bool keeps_F, Layout& layout);
  /// Always last: c_L, Qv -> signal speed; `density` that of the start.
  Stage* (*signal_speed)(double q_lin, double q_quad, double density, Layout& layout);
};

}  // namespace krater
