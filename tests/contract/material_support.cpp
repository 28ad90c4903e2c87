// SPDX-License-Identifier: GPL-3.0-or-later
#include "material_support.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
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
