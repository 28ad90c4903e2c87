// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The catalogue: one entry per law of materials/law_list.hpp, for reading scenes, `krater models`
/// and the manual.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "krater/core/parameters.hpp"
#include "krater/materials/factories.hpp"
#include "krater/points/fields.hpp"

namespace krater {

struct LawInfo {
  std::string family;  ///< the block of the scene: strength, damage, eos, model, ...
  std::string name;
  std::vector<ParameterInfo> parameters;  ///< in the order `StageFactory::make` takes their values
  std::string equation;
  std::string reference;
  std::vector<const FieldInfo*> columns;  ///< of its own state
  bool needs_shear_modulus;               ///< the material must have shear_modulus > 0
  bool whole_stress;                      ///< gives the pressure too: must be used without an eos
  bool yields;      ///< strength with a yield stress: what damage and heating need
  bool dilates;     ///< strength whose flow opens voids
  bool fails;       ///< model whose points fail
  bool needs_flow;  ///< damage that grows with plastic strain: the strength must yield
  bool burns;       ///< eos of an explosive that becomes products in the run
  bool needs_eos;   ///< heating whose temperature is that of the equation of state
};

const std::vector<LawInfo>& catalogue();

/// Index in catalogue(), or -1.
int find_law(std::string_view family, std::string_view name);

/// Names of a family, in catalogue order; the message of an unknown name lists them.
std::vector<std::string> law_names(std::string_view family);

/// The words that a parameter takes instead of a number, in the order of their values; empty where
/// it is a number.
std::vector<std::string> parameter_words(const ParameterInfo& info);

/// Does a damage law, or a model, degrade the stress, or only tell the failure?
bool law_degrades(int law, const double* values, const MaterialConstants& constants);

/// Heat c_v T that an equation of state with a caloric relation of its own has at the start
/// [J/kg]; nothing where the temperature counts from the start.
std::optional<double> thermal_energy_at_start(int law, const double* values,
                                              const MaterialConstants& constants);

/// Bulk sound speed at rest of an equation of state or a model [m/s]; nothing of other laws.
std::optional<double> sound_speed_at_rest(int law, const double* values,
                                          const MaterialConstants& constants);

/// Shear modulus at rest of a model that has its own [Pa]; nothing of other laws.
std::optional<double> own_shear_modulus(int law, const double* values,
                                        const MaterialConstants& constants);

/// Largest width over which the softening of a model may localise [m]: its energy per area would
/// snap back in a wider one. Nothing where no energy rules the softening.
std::optional<double> largest_length(int law, const double* values,
                                     const MaterialConstants& constants);

/// A constant that a law makes of its parameters and a user wants to know.
struct DerivedConstant {
  const char* name;
  double value;
  const char* unit;
};
std::vector<DerivedConstant> derived_constants(int law, const double* values,
                                               const MaterialConstants& constants);

/// The front that burns an explosive; nothing where none does.
struct ProgrammedFront {
  double speed;  ///< D [m/s]
  double width;  ///< [cells]
};
std::optional<ProgrammedFront> programmed_front(int law, const double* values,
                                                const MaterialConstants& constants);

/// What is wrong between parameters that are each in range (T_melt below T_ref), or nullptr.
const char* law_problem(int law, const double* values, const MaterialConstants& constants);

}  // namespace krater
