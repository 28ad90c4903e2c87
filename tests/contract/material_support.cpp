// SPDX-License-Identifier: GPL-3.0-or-later
#include "material_support.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <stdexcept>

namespace krater::test {

namespace {

constexpr int kZeros = 9 * kLanes;

double* aligned(double* p) {
  return reinterpret_cast<double*>((reinterpret_cast<std::uintptr_t>(p) + 63U) &
                                   ~std::uintptr_t{63});
}

const Column& column(const std::vector<Column>& columns, const char* field) {
  for (const Column& c : columns) {
    if (std::strcmp(c.field->name, field) == 0) return c;
  }
  throw std::out_of_range{std::string{"no column "} + field};
}

}  // namespace

std::vector<Level> levels() {
  std::vector<Level> found{{"portable", stage_factory_isa_portable()}};
#if defined(KRATER_HAVE_V3)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    found.push_back({"v3", stage_factory_isa_v3()});
  }
#endif
#if defined(KRATER_HAVE_V4)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl")) {
    found.push_back({"v4", stage_factory_isa_v4()});
  }
#endif
  return found;
}

std::vector<double> typical_parameters(const LawInfo& law) {
  static const std::map<std::string, double> values{
      {"von_mises.Y", 120e6},
      {"von_mises.H", 300e6},
      {"johnson_cook.A", 90e6},
      {"johnson_cook.B", 292e6},
      {"johnson_cook.n", 0.31},
      {"johnson_cook.C", 0.025},
      {"johnson_cook.epsdot0", 1.0},
      {"johnson_cook.m", 1.09},
      {"johnson_cook.T_ref", 294.0},
      {"johnson_cook.T_melt", 1356.0},
      {"voce.A", 90e6},
      {"voce.Q1", 120e6},
      {"voce.C1", 15.0},
      {"voce.Q2", 150e6},
      {"voce.C2", 1.5},
      {"voce.C", 0.012},
      {"voce.epsdot0", 5e-4},
      {"voce.m", 1.09},
      {"voce.T_ref", 294.0},
      {"voce.T_melt", 1356.0},
      {"zerilli_armstrong_fcc.C0", 65e6},
      {"zerilli_armstrong_fcc.C2", 890e6},
      {"zerilli_armstrong_fcc.C3", 0.0028},
      {"zerilli_armstrong_fcc.C4", 0.000115},
      {"zerilli_armstrong_fcc.epsdot0", 1e-4},
      {"zerilli_armstrong_bcc.C0", 65e6},
      {"zerilli_armstrong_bcc.C1", 1033e6},
      {"zerilli_armstrong_bcc.C3", 0.00698},
      {"zerilli_armstrong_bcc.C4", 0.000415},
      {"zerilli_armstrong_bcc.C5", 266e6},
      {"zerilli_armstrong_bcc.n", 0.289},
      {"zerilli_armstrong_bcc.epsdot0", 1e-4},
      {"steinberg_guinan.Y0", 120e6},
      {"steinberg_guinan.Y_max", 640e6},
      {"steinberg_guinan.beta", 36.0},
      {"steinberg_guinan.n", 0.45},
      {"steinberg_guinan.eps_i", 0.0},
      {"steinberg_guinan.A", 2.83e-11},
      {"steinberg_guinan.B", 3.77e-4},
      {"steinberg_guinan.r", 1.0},
      {"steinberg_guinan.T_melt", 1790.0},
      {"steinberg_guinan.a", 1.5},
      {"steinberg_guinan.gamma0", 2.02},
      {"drucker_prager.Y", 100e6},
      {"drucker_prager.alpha", 0.6},
      {"drucker_prager.dilatancy", 0.2},
      {"drucker_prager.bulking_limit", 0.05},
      {"neo_hookean.lame_lambda", 1e11},
      {"linear.bulk_modulus", 139e9},
      {"mie_gruneisen_polynomial.a0", 139e9},
      {"mie_gruneisen_polynomial.b0", 275e9},
      {"mie_gruneisen_polynomial.c0", 470e9},
      {"mie_gruneisen_polynomial.gamma0", 2.02},
      {"mie_gruneisen_shock.c0", 3940.0},
      {"mie_gruneisen_shock.S1", 1.489},
      {"mie_gruneisen_shock.gamma0", 2.02},
      {"p_alpha.solid_density", 11200.0},
      {"p_alpha.c0", 3940.0},
      {"p_alpha.S1", 1.489},
      {"p_alpha.gamma0", 2.02},
      {"p_alpha.elastic_pressure", 0.2e9},
      {"p_alpha.compaction_pressure", 2e9},
      {"p_alpha.exponent", 2.0},
      {"ideal_gas.gamma", 1.4},
      {"ideal_gas.initial_pressure", 1e9},
      {"stiffened_gas.gamma", 4.0},
      {"stiffened_gas.p_inf", 34.656e9},
      {"stiffened_gas.initial_pressure", 1e8},
      {"jwl.A", 371.2e9},
      {"jwl.B", 3.231e9},
      {"jwl.R1", 4.15},
      {"jwl.R2", 0.95},
      {"jwl.omega", 0.30},
      {"jwl.E0", 7.0e9},
      {"jwl_burn.A", 371.2e9},
      {"jwl_burn.B", 3.231e9},
      {"jwl_burn.R1", 4.15},
      {"jwl_burn.R2", 0.95},
      {"jwl_burn.omega", 0.30},
      {"jwl_burn.E0", 7.0e9},
      {"jwl_burn.D", 2956.0},  // of TNT's energy in the density of kCopper
      {"jwl_burn.p_CJ", 21.0e9},
      {"jwl_burn.bulk_modulus", 10.8e9},
      {"jwl_burn.front_width", 3.0},
      {"jwl_burn.burn", 0.0},
      {"tillotson.a", 0.5},
      {"tillotson.b", 1.5},
      {"tillotson.A", 139e9},
      {"tillotson.B", 110e9},
      {"tillotson.E0", 32.5e6},
      {"tillotson.E_iv", 1.4e6},
      {"tillotson.E_cv", 6.9e6},
      {"tillotson.alpha", 5.0},
      {"tillotson.beta", 5.0},
      {"linear_quadratic.q_lin", 0.3},
      {"linear_quadratic.q_quad", 2.0},
      {"lemaitre_energy.S", 0.2e6},
      {"lemaitre_energy.s", 1.0},
      {"lemaitre_energy.eps_d", 1e-3},
      {"lemaitre_energy.phi_c", 0.8},
      {"lemaitre_energy.triaxiality_min", -1.0 / 3.0},
      {"lemaitre_threshold.e_F", 0.04},
      {"lemaitre_threshold.e_D", 0.002},
      {"lemaitre_threshold.s", 0.9},
      {"lemaitre_threshold.phi_c", 0.8},
      {"lemaitre_threshold.triaxiality_min", -1.0 / 3.0},
      {"johnson_cook.D1", 0.01},
      {"johnson_cook.D2", 0.02},
      {"johnson_cook.D3", -1.5},
      {"johnson_cook.D4", 0.014},
      {"johnson_cook.D5", 1.12},
      {"johnson_cook.eps_f_min", 1e-3},
      {"johnson_cook.gamma_D", 0.1},
      {"johnson_cook.phi_c", 0.7},
      {"johnson_cook.normalise", 0.0},
      {"johnson_cook_uncoupled.D1", 0.01},
      {"johnson_cook_uncoupled.D2", 0.02},
      {"johnson_cook_uncoupled.D3", -1.5},
      {"johnson_cook_uncoupled.D4", 0.014},
      {"johnson_cook_uncoupled.D5", 1.12},
      {"johnson_cook_uncoupled.epsdot0", 1.0},
      {"johnson_cook_uncoupled.T_ref", 294.0},
      {"johnson_cook_uncoupled.T_melt", 1356.0},
      {"johnson_cook_uncoupled.eps_f_min", 1e-3},
      {"johnson_cook_uncoupled.softening", 0.0},
      {"cockcroft_latham.W_c", 3e6},
      {"maximum_plastic_strain.eps_max", 0.02},
      {"tuler_butcher.stress", 2e8},
      {"tuler_butcher.exponent", 2.0},
      {"tuler_butcher.time", 1e-7},
      {"holmquist_johnson_cook.compressive_strength", 48e6},
      {"holmquist_johnson_cook.A", 0.79},
      {"holmquist_johnson_cook.B", 1.6},
      {"holmquist_johnson_cook.N", 0.61},
      {"holmquist_johnson_cook.C", 0.007},
      {"holmquist_johnson_cook.epsdot0", 1.0},
      {"holmquist_johnson_cook.S_max", 7.0},
      {"holmquist_johnson_cook.D1", 0.04},
      {"holmquist_johnson_cook.D2", 1.0},
      {"holmquist_johnson_cook.eps_f_min", 0.01},
      {"holmquist_johnson_cook.tensile_strength", 4e6},
      {"holmquist_johnson_cook.crush_pressure", 16e6},
      {"holmquist_johnson_cook.crush_compression", 1e-3},
      {"holmquist_johnson_cook.lock_pressure", 0.8e9},
      {"holmquist_johnson_cook.lock_compression", 0.1},
      {"holmquist_johnson_cook.lock_strain", 0.0},
      {"holmquist_johnson_cook.K1", 85e9},
      {"holmquist_johnson_cook.K2", -171e9},
      {"holmquist_johnson_cook.K3", 208e9},
      {"holmquist_johnson_cook.unloading", 0.0},
      {"holmquist_johnson_cook.cohesion", 0.0},
      {"holmquist_johnson_cook.tension", 0.0},
      {"holmquist_johnson_cook.tension_cut", 0.0},
      {"holmquist_johnson_cook.fracture_energy", 0.0},
      {"osborn.c0", 37.92e6},  // concrete of 48 MPa
      {"osborn.c1", 1584.18},
      {"osborn.n", 0.61},
      {"osborn.c3", 0.007},
      {"osborn.epsdot0", 1.0},
      {"osborn.sigma_max", 336e6},
      {"osborn.tensile_strength", 4e6},
      {"osborn.crush_pressure", 16e6},
      {"osborn.crush_compression", 1e-3},
      {"osborn.lock_pressure", 0.8e9},
      {"osborn.lock_compression", 0.1},
      {"osborn.K1", 85e9},
      {"osborn.K2", -171e9},
      {"osborn.K3", 208e9},
      {"karagozian_case.compressive_strength", 39.3e6},
      {"cscm.compressive_strength", 39.3e6},
      {"rht.compressive_strength", 35e6},  // C30/37
      {"rht.A", 1.6},
      {"rht.n", 0.61},
      {"rht.shear_strength", 0.18},
      {"rht.tensile_strength", 0.1},
      {"rht.Q0", 0.6805},
      {"rht.B", 0.0105},
      {"rht.g_c", 0.53},
      {"rht.g_t", 0.7},
      {"rht.hardening", 0.5},
      {"rht.D1", 0.04},
      {"rht.D2", 1.0},
      {"rht.eps_f_min", 0.01},
      {"rht.A_f", 1.6},
      {"rht.n_f", 0.61},
      {"rht.rate_factor", 0.0},
      {"rht.fracture_energy", 0.0},
      {"rht.A1", 35.27e9},
      {"rht.A2", 39.58e9},
      {"rht.A3", 9.04e9},
      {"rht.B0", 1.22},
      {"rht.B1", 1.22},
      {"rht.T1", 35.27e9},
      {"rht.T2", 0.0},
      {"rht.distension", 1.1884},
      {"rht.elastic_pressure", 23.3e6},
      {"rht.compaction_pressure", 6e9},
      {"rht.exponent", 3.0},
      {"kinetic_damage.compressive_strength", 39.3e6},
      {"kinetic_damage.tensile_strength", 3.476e6},
      {"kinetic_damage.intact_slope", 3.0},
      {"kinetic_damage.damaged_slope", 2.5},
      {"kinetic_damage.strength_max", 7.0},
      {"kinetic_damage.overload_max", 3.0},
      {"kinetic_damage.exponent", 2.0},
      {"kinetic_damage.shear_time", 1e-5},
      {"kinetic_damage.tension_time", 3e-6},
      {"kinetic_damage.crush_pressure", 13.1e6},
      {"kinetic_damage.crush_compression", 7.947e-4},
      {"kinetic_damage.lock_pressure", 0.8e9},
      {"kinetic_damage.lock_compression", 0.1269},
      {"kinetic_damage.K1", 85e9},
      {"kinetic_damage.K2", -171e9},
      {"kinetic_damage.K3", 208e9},
      {"drucker_prager.compressive_strength", 39.3e6},
      {"drucker_prager.tensile_strength", 3.93e6},
      {"drucker_prager.bulk_modulus", 16.48e9},
      {"drucker_prager.cap", 0.0},
      {"drucker_prager.cap_shape", 2.0},
      {"drucker_prager.air_voids", 0.113},
      {"drucker_prager.lock_pressure", 0.8e9},
      {"johnson_holmquist_2.A", 0.85},  // AlN
      {"johnson_holmquist_2.N", 0.29},
      {"johnson_holmquist_2.B", 0.31},
      {"johnson_holmquist_2.M", 0.21},
      {"johnson_holmquist_2.C", 0.013},
      {"johnson_holmquist_2.epsdot0", 1.0},
      {"johnson_holmquist_2.tensile_strength", 320e6},
      {"johnson_holmquist_2.fractured_max", 0.35},
      {"johnson_holmquist_2.HEL", 9e9},
      {"johnson_holmquist_2.P_HEL", 5e9},
      {"johnson_holmquist_2.D1", 0.02},
      {"johnson_holmquist_2.D2", 1.85},
      {"johnson_holmquist_2.K1", 201e9},
      {"johnson_holmquist_2.K2", 260e9},
      {"johnson_holmquist_2.K3", 0.0},
      {"johnson_holmquist_2.beta", 1.0},
      {"plastic_work.fraction", 0.9},
      {"plastic_work.cp", 383.0},
      {"energy.c_v", 383.0},
  };
  std::vector<double> result;
  const std::string name = law.name == "voce_log" ? "voce" : law.name;
  for (const ParameterInfo& p : law.parameters) {
    const auto known = values.find(name + '.' + p.key);
    // Of a law that generates its constants the strength is enough.
    const bool generated =
        !std::isnan(p.fallback) && (law.name == "karagozian_case" || law.name == "cscm");
    result.push_back(known == values.end() && generated ? p.fallback
                                                        : values.at(name + '.' + p.key));
  }
  return result;
}

std::vector<Recipe> all_recipes() {
  std::vector<Recipe> recipes;
  for (const LawInfo& strength : catalogue()) {
    if (strength.family != "strength") continue;
    const bool plastic = strength.name != "elastic" && !strength.whole_stress;
    if (strength.whole_stress) {
      recipes.push_back({.strength = strength.name, .eos = ""});
      recipes.push_back({.strength = strength.name, .eos = "", .track_deformation = true});
      continue;
    }
    for (const std::string& eos : law_names("eos")) {
      recipes.push_back({.strength = strength.name, .eos = eos, .heating = plastic});
    }
  }
  for (const std::string& damage : law_names("damage")) {
    const Recipe recipe{.strength = "johnson_cook",
                        .eos = "mie_gruneisen_shock",
                        .heating = true,
                        .damage = damage};
    recipes.push_back(recipe);
    if (!catalogue().at(static_cast<std::size_t>(find_law("damage", damage))).needs_flow)
      recipes.push_back({.strength = "elastic", .eos = "mie_gruneisen_shock", .damage = damage});
    const auto values =
        typical_parameters(catalogue().at(static_cast<std::size_t>(find_law("damage", damage))));
    if (!law_degrades(find_law("damage", damage), values.data(), kCopper)) continue;
    recipes.push_back(recipe);
    recipes.back().coupling = Coupling::rate;
    recipes.back().strength = "von_mises";
    recipes.back().spall_strength = 1e8;
  }
  recipes.push_back({.strength = "johnson_cook",
                     .eos = "mie_gruneisen_polynomial",
                     .damage = "lemaitre_energy",
                     .coupling = Coupling::rate,
                     .degrade = DegradePressure::all});
  recipes.push_back({.strength = "johnson_cook",
                     .eos = "mie_gruneisen_shock",
                     .heating = true,
                     .damage = "johnson_cook_uncoupled",
                     .parameters = {{"johnson_cook_uncoupled.softening", 1.0}}});
  for (const Rate rate : {Rate::truesdell_projected, Rate::jaumann, Rate::green_naghdi}) {
    recipes.push_back({.strength = "elastic", .eos = "linear", .rate = rate});
    recipes.push_back(
        {.strength = "johnson_cook", .eos = "mie_gruneisen_shock", .heating = true, .rate = rate});
    recipes.push_back({.strength = "von_mises",
                       .eos = "linear",
                       .damage = "johnson_cook",
                       .rate = rate,
                       .degrade = DegradePressure::none});
  }
  // Laws that read the pressure or vary G, in parts: both couplings, every rate, spall.
  for (const char* strength : {"steinberg_guinan", "drucker_prager"}) {
    for (const Coupling coupling : {Coupling::effective, Coupling::rate}) {
      recipes.push_back(
          {.strength = strength,
           .eos = "mie_gruneisen_shock",
           .heating = coupling == Coupling::rate,
           .damage = "lemaitre_energy",
           .coupling = coupling,
           .degrade = coupling == Coupling::rate ? DegradePressure::all : DegradePressure::tension,
           .spall_strength = coupling == Coupling::rate ? 1e8 : 0.0,
           .thermal = coupling == Coupling::effective});
    }
    for (const Rate rate : {Rate::truesdell_projected, Rate::jaumann, Rate::green_naghdi}) {
      recipes.push_back({.strength = strength, .eos = "linear", .heating = true, .rate = rate});
    }
    recipes.push_back({.strength = strength,
                       .eos = "mie_gruneisen_shock",
                       .damage = "johnson_cook",
                       .rate = Rate::jaumann});
  }
  for (const std::string& eos : law_names("eos")) {
    recipes.push_back({.strength = "johnson_cook", .eos = eos, .thermal = true});
  }
  recipes.push_back({.strength = "", .eos = "ideal_gas", .thermal = true});
  recipes.push_back({.strength = "drucker_prager", .eos = "mie_gruneisen_shock", .thermal = true});
  recipes.push_back({.strength = "johnson_cook",
                     .eos = "tillotson",
                     .damage = "johnson_cook",
                     .spall_strength = 1e8,
                     .thermal = true});
  recipes.push_back({.strength = "elastic", .eos = "mie_gruneisen_shock", .spall_strength = 2e8});
  for (const char* strength : {"", "elastic", "johnson_cook", "drucker_prager"})
    recipes.push_back({.strength = strength,
                       .eos = "mie_gruneisen_shock",
                       .heating = std::string{"johnson_cook"} == strength,
                       .rate = *strength == 'j' ? Rate::jaumann : Rate::truesdell,
                       .spall_strength = 2e8,
                       .spall_action = SpallAction::fail});
  for (const std::string& model : law_names("model")) {
    for (int rate = 0; rate < 4; ++rate)
      recipes.push_back({.strength = "",
                         .eos = "",
                         .heating = rate == 0,
                         .rate = static_cast<Rate>(rate),
                         .model = model});
  }
  for (const std::string& eos : law_names("eos")) {  // fluids
    recipes.push_back({.strength = "", .eos = eos, .viscosity = eos != "linear"});
  }
  return recipes;
}

std::string describe(const Recipe& recipe) {
  return recipe.model + recipe.strength + " + " + recipe.eos +
         (recipe.viscosity ? " + viscosity" : "") + (recipe.heating ? " + heating" : "") +
         (recipe.thermal ? " + heating by energy" : "") + (recipe.track_deformation ? " + F" : "") +
         (recipe.damage.empty() ? "" : " + damage " + recipe.damage) +
         (recipe.coupling == Coupling::rate ? " (rate)" : "") +
         (recipe.spall_strength > 0 ? " + spall" : "") + ", " +
         kRateNames[static_cast<int>(recipe.rate)];
}

Body::Body(const StageFactory& factory, const Recipe& recipe, int points, int batch_size)
    : layout_{3},
      constants_{recipe.constants},
      points_{points},
      batch_size_{batch_size},
      groups_per_batch_{(batch_size + kLanes - 1) / kLanes},
      groups_{(points + batch_size - 1) / batch_size * groups_per_batch_} {
  layout_.state<field::Mass>(0.0, "method");
  if (recipe.track_deformation) layout_.state<field::DeformationGradient>(0.0, "output");
  layout_.local_output<field::StepGradient>("method");
  layout_.local_output<field::ExtraDilatation>("method");
  std::vector<std::vector<double>> kept;
  kept.reserve(6);
  const auto planned = [&](const char* family, const std::string& name) -> PlannedLaw {
    if (name.empty()) return {};
    const int law = find_law(family, name);
    const LawInfo& info = catalogue().at(static_cast<std::size_t>(law));
    kept.push_back(typical_parameters(info));
    for (std::size_t i = 0; i < info.parameters.size(); ++i) {
      const auto own = recipe.parameters.find(name + '.' + info.parameters[i].key);
      if (own != recipe.parameters.end()) kept.back()[i] = own->second;
    }
    return {law, kept.back().data()};
  };
  MaterialPlan plan;
  plan.constants = constants_;
  plan.strength = planned("strength", recipe.strength);
  plan.eos = planned("eos", recipe.eos);
  plan.damage = planned("damage", recipe.damage);
  plan.model = planned("model", recipe.model);
  plan.viscosity = planned("viscosity", recipe.viscosity ? "linear_quadratic" : "");
  plan.heating =
      planned("heating", recipe.heating ? "plastic_work" : (recipe.thermal ? "energy" : ""));
  plan.rate = recipe.rate, plan.coupling = recipe.coupling, plan.degrade = recipe.degrade;
  if (recipe.spall_strength > 0) plan.spall_strength = recipe.spall_strength;
  plan.spall_action = recipe.spall_action;
  if (recipe.viscosity) plan.q_lin = 0.3, plan.q_quad = 2.0;
  stages_ = make_stages(factory, plan, layout_);
  layout_.check();

  const int state_size = groups_ * layout_.stride(), local_size = groups_ * layout_.local_stride();
  storage_.assign(
      static_cast<std::size_t>(state_size + local_size + kZeros + (groups_ + 3) * kLanes), 0.0);
  zeros_ = aligned(storage_.data());
  state_ = zeros_ + kZeros;
  local_ = state_ + state_size;
  lengths_ = local_ + local_size;  // one per point: a grid gives one to all
  std::fill_n(lengths_, groups_ * kLanes, 1e-4);
  for (int i = 0; i < points_; ++i) {
    for (const Column& c : layout_.columns()) {
      for (int k = 0; k < c.components; ++k) state(c.field->name, i, k) = c.initial;
    }
    state("density", i) = constants_.density;
    state("mass", i) = 1e-9 * (1.0 + 0.1 * i);
    if (layout_.find("deformation_gradient") != nullptr) {
      for (const int k : {0, 4, 8}) state("deformation_gradient", i, k) = 1.0;
    }
  }
}

int Body::slot(int point) const {
  const int batch = point / batch_size_, inside = point % batch_size_;
  return batch * groups_per_batch_ * kLanes + inside;
}

double& Body::state(const char* field, int point, int component) {
  const Column& c = column(layout_.columns(), field);
  const int s = slot(point);
  return state_[s / kLanes * layout_.stride() + c.offset + component * kLanes + s % kLanes];
}

double& Body::local(const char* field, int point, int component) {
  const Column& c = column(layout_.locals(), field);
  const int s = slot(point);
  return local_[s / kLanes * layout_.local_stride() + c.offset + component * kLanes + s % kLanes];
}

void Body::pad() {
  for (int b = 0; b < batches(); ++b) {
    const int last = std::min((b + 1) * batch_size_, points_) - 1;
    const int from = slot(last), end = (b + 1) * groups_per_batch_ * kLanes;
    const auto copy = [&](double* base, int stride, int to) {
      for (int k = 0; k < stride; k += kLanes) {
        base[to / kLanes * stride + k + to % kLanes] =
            base[from / kLanes * stride + k + from % kLanes];
      }
    };
    const int mass = column(layout_.columns(), "mass").offset;
    for (int to = from + 1; to < end; ++to) {
      copy(state_, layout_.stride(), to);
      copy(local_, layout_.local_stride(), to);
      state_[to / kLanes * layout_.stride() + mass + to % kLanes] = 0.0;
    }
  }
}

BatchData Body::batch(int index, double dt) {
  const int first = index * groups_per_batch_;
  const int count = std::min(batch_size_, points_ - index * batch_size_);
  return {.state = state_ + first * layout_.stride(),
          .state_stride = layout_.stride(),
          .local = local_ + first * layout_.local_stride(),
          .local_stride = layout_.local_stride(),
          .zeros = zeros_,
          .groups = (count + kLanes - 1) / kLanes,
          .count = count,
          .first_group = first,
          .dt = dt,
          .length = lengths_ + first * kLanes,
          .length_stride = kLanes,
          .ledger = &ledger,
          .fault = &fault};
}

void Body::step(double dt) {
  pad();
  for (int b = 0; b < batches(); ++b) {
    const BatchData data = batch(b, dt);
    for (const NamedStage& stage : stages_) stage.stage->apply(data);
  }
}

std::vector<double> Body::everything(int point) {
  std::vector<double> values;
  for (const Column& c : layout_.columns()) {
    for (int k = 0; k < c.components; ++k) values.push_back(state(c.field->name, point, k));
  }
  for (const Column& c : layout_.locals()) {
    for (int k = 0; k < c.components; ++k) values.push_back(local(c.field->name, point, k));
  }
  return values;
}

void set_motion(Body& body, int step, double size) {
  for (int i = 0; i < body.points(); ++i) {
    for (int k = 0; k < 9; ++k) {
      const double phase = 0.37 * i + 1.7 * k + 0.11 * step * (1 + k % 3);
      body.local("step_gradient", i, k) = size * std::sin(phase) * (1 + i % 5);
    }
    body.local("extra_dilatation", i) = 0.2 * size * std::cos(0.9 * i + 0.3 * step);
  }
}

}  // namespace krater::test
