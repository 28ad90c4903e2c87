// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A body without a grid: a layout, the stages of a material at one instruction-set level, and
/// points in batches of any size, as the method would hand them over. Every law of the catalogue
/// must have typical parameters here.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "krater/materials/assembly.hpp"
#include "krater/materials/catalogue.hpp"
#include "krater/points/batch.hpp"

namespace krater::test {

/// The levels that this build has and this machine can run.
struct Level {
  const char* name;
  const StageFactory* factory;
};
std::vector<Level> levels();

/// Plausible values (copper) for a law's parameters, in declared order; throws if a key is not
/// known here.
std::vector<double> typical_parameters(const LawInfo& law);

/// Constants of the same copper.
inline constexpr MaterialConstants kCopper{8960.0, 46e9, 294.0};

/// Names of laws, by family; an empty name leaves the family out.
struct Recipe {
  std::string strength, eos;
  bool viscosity = true;
  bool heating = false;            ///< plastic_work
  bool track_deformation = false;  ///< a column F that the kinematics stage keeps
  std::string damage = {};
  Rate rate = Rate::truesdell;
  Coupling coupling = Coupling::effective;
  DegradePressure degrade = DegradePressure::tension;
  double spall_strength = 0;  ///< 0: none
  SpallAction spall_action = SpallAction::limit;
  /// Instead of typical_parameters: "law.key" and value.
  std::map<std::string, double> parameters = {};
  MaterialConstants constants = kCopper;
  bool thermal = false;    ///< heating: energy
  std::string model = {};  ///< coupled law, in place of strength, eos and damage
};
/// Every strength with every eos (or none, if it gives the whole stress), every damage law with the
/// couplings it allows, every rate with and without damage, every model with every rate; from the
/// catalogue.
std::vector<Recipe> all_recipes();
std::string describe(const Recipe& recipe);

class Body {
 public:
  /// `points` in consecutive batches of `batch_size`.
  Body(const StageFactory& factory, const Recipe& recipe, int points, int batch_size);

  const Layout& layout() const { return layout_; }
  const std::vector<NamedStage>& stages() const { return stages_; }
  int points() const { return points_; }

  double& state(const char* field, int point, int component = 0);
  double& local(const char* field, int point, int component = 0);

  /// One step: padding is refreshed with copies of the last point, then every stage sees every
  /// batch.
  void step(double dt);

  /// The batches of a step, as the stages see them; step() pads them first.
  int batches() const { return groups_ / groups_per_batch_; }
  BatchData batch(int index, double dt);
  /// All state and local records, to be kept and put back.
  std::vector<double>& storage() { return storage_; }

  /// Every state and local value of a point, in column order, for comparison of bits.
  std::vector<double> everything(int point);

  Ledger ledger;
  Fault fault;

 private:
  int slot(int point) const;
  void pad();

  Layout layout_;
  MaterialConstants constants_;
  std::vector<NamedStage> stages_;
  int points_, batch_size_, groups_per_batch_, groups_;
  std::vector<double> storage_;
  double *state_, *local_, *zeros_, *lengths_;
};

/// Step gradients of a violent, smooth, reproducible motion.
void set_motion(Body& body, int step, double size);

}  // namespace krater::test
