// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/materials/assembly.hpp"

#include <cmath>
#include <stdexcept>

#include "krater/materials/catalogue.hpp"

namespace krater {

namespace {

const LawInfo& info(const PlannedLaw& law) {
  return catalogue().at(static_cast<std::size_t>(law.law));
}

/// What laws ask of stages that are not theirs, known before the first stage is made.
struct Needs {
  bool keeps_F;  ///< a law, the rate, or who made the layout wants the deformation gradient
  bool dilates;  ///< voids of plastic flow, and a limit of tension with them
};

Needs needs_of(const MaterialPlan& plan, const Layout& layout) {
  const bool strong = plan.strength.law >= 0;
  return {.keeps_F = (strong && info(plan.strength).whole_stress) ||
                     plan.rate == Rate::green_naghdi ||
                     layout.find(field::DeformationGradient::info.name) != nullptr,
          .dilates = strong && info(plan.strength).dilates};
}

struct Assembler {
  const StageFactory& factory;
  const MaterialPlan& plan;
  const Needs needs;
  Layout& layout;
  std::vector<NamedStage> stages;

  void add(std::string name, Stage* stage) {
    if (stage == nullptr) throw std::logic_error("no stage was made for " + name);
    stages.push_back({std::move(name), std::unique_ptr<const Stage>{stage}});
  }

  void add_law(const PlannedLaw& law) {
    if (law.law < 0) return;
    add(info(law).family + ": " + info(law).name,
        factory.make(law.law, law.values, plan.constants, layout));
  }

  bool degrades() const { return degrades_stress(plan); }
  bool carries() const { return plan.damage.law >= 0 || std::isfinite(plan.spall_strength); }
  bool parts() const {
    return std::isfinite(plan.spall_strength) && plan.spall_action == SpallAction::fail;
  }
  Integrity integrity() const {
    if (plan.damage.law >= 0) return Integrity::damaged;
    return parts() ? Integrity::failing : Integrity::sound;
  }
  Tension tension() const {
    if (parts()) return Tension::parting;
    return carries() ? Tension::carried : Tension::own;
  }

  void add_part(Part part, const PlannedLaw& law, const std::string& name) {
    add_part(part, law, name, integrity());
  }
  void add_part(Part part, const PlannedLaw& law, const std::string& name, Integrity whole) {
    add(name, factory.part({.part = part,
                            .law = law.law,
                            .values = law.values,
                            .constants = plan.constants,
                            .rate = plan.rate,
                            .integrity = whole,
                            .degrades = degrades(),
                            .degrade = plan.degrade,
                            .dilates = needs.dilates},
                           layout));
  }

  void add_split_deviator() {
    const bool yields = info(plan.strength).yields, damaged = plan.damage.law >= 0;
    const std::string strength = "strength: " + info(plan.strength).name,
                      damage = damaged ? "damage: " + info(plan.damage).name : "";
    add_part(Part::start, plan.strength, "start of the step");
    add_part(Part::trial, {}, rate_name());
    if (damaged && plan.coupling == Coupling::rate) {
      add_part(Part::flow_stress, plan.strength, strength + " (flow stress)");
      add_part(Part::growth, plan.damage, damage);
      add_part(Part::rate_return, plan.strength, strength);
    } else {
      if (yields || damaged) add_part(Part::plastic_return, plan.strength, strength);
      if (damaged) add_part(Part::growth, plan.damage, damage);
    }
    add_part(Part::carried, {}, "carried stress");
  }

  /// The strength's stages stand from `first` on; they have declared what the deviator needs.
  void add_cohesion(std::ptrdiff_t first) {
    if (plan.eos.law < 0) return;
    const StagesAround around =
        factory.cohesion(plan.eos.law, plan.eos.values, plan.constants, layout);
    if (around.before == nullptr) return;
    stages.insert(stages.begin() + first,
                  {"effective deviator", std::unique_ptr<const Stage>{around.before}});
    add("cohesion", around.after);
  }

  std::string rate_name() const {
    return std::string{"rate: "} + kRateNames[static_cast<int>(plan.rate)];
  }

  void add_model() {
    add_part(Part::start, plan.model, "start of the step");
    add_part(Part::trial, {}, rate_name(), degrades() ? Integrity::damaged : Integrity::sound);
    add_law(plan.model);
  }

  void add_eos() {
    if (plan.eos.law < 0) return;
    add("eos: " + info(plan.eos).name + (carries() ? ", carried" : "") + (parts() ? ", spall" : ""),
        factory.eos({.law = plan.eos.law,
                     .values = plan.eos.values,
                     .constants = plan.constants,
                     .tension = tension(),
                     .spall_strength = plan.spall_strength,
                     .dilates = needs.dilates},
                    layout));
  }

  /// Of an explosive, before its equation of state, which has declared what burns.
  void add_burn() {
    if (plan.eos.law < 0) return;
    const Stage* burn = factory.burn(plan.eos.law, plan.eos.values, plan.constants, layout);
    if (burn == nullptr) return;
    stages.insert(stages.end() - 1, {"burn", std::unique_ptr<const Stage>{burn}});
  }

  void add_heating() {
    if (plan.heating.law < 0 || !info(plan.heating).needs_eos) return add_law(plan.heating);
    add("heating: " + info(plan.heating).name,
        factory.energy_heating({.eos = plan.eos.law,
                                .eos_values = plan.eos.values,
                                .c_v = plan.heating.values[0],
                                .constants = plan.constants,
                                .carries = carries() || needs.dilates,
                                .degrades = degrades()},
                               layout));
  }
};

}  // namespace

bool degrades_stress(const MaterialPlan& plan) {
  const PlannedLaw& law = plan.model.law >= 0 ? plan.model : plan.damage;
  return law.law >= 0 && law_degrades(law.law, law.values, plan.constants);
}

std::vector<NamedStage> make_stages(const StageFactory& factory, const MaterialPlan& plan,
                                    Layout& layout) {
  Assembler all{factory, plan, needs_of(plan, layout), layout, {}};
  const bool split = all.integrity() != Integrity::sound || plan.rate != Rate::truesdell;
  all.add("kinematics", factory.kinematics(all.needs.keeps_F, layout));
  all.add_law(plan.viscosity);
  const auto first = std::ssize(all.stages);
  if (plan.model.law >= 0) {
    all.add_model();
  } else if (split && plan.strength.law >= 0) {
    all.add_split_deviator();
  } else {
    all.add_law(plan.strength);
  }
  if (plan.strength.law >= 0) all.add_cohesion(first);
  all.add_eos();
  all.add_burn();
  all.add_heating();
  all.add("signal speed",
          factory.signal_speed(plan.q_lin, plan.q_quad, plan.constants.density, layout));
  return std::move(all.stages);
}

}  // namespace krater
