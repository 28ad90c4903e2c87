// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/app/effects.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "krater/app/card_doctor.hpp"
#include "krater/core/parallel.hpp"
#include "krater/materials/catalogue.hpp"

namespace krater {

namespace {

constexpr EffectKind kOfMaterial[] = {
    EffectKind::strength,  EffectKind::eos,     EffectKind::model,  EffectKind::rate,
    EffectKind::viscosity, EffectKind::heating, EffectKind::damage, EffectKind::spall};

/// "inputs/taylor.yaml:31: materials.copper.heating" -> "taylor.yaml:31".
std::string place_of(const std::string& where) {
  const std::string place = where.substr(0, where.find(": "));
  const std::size_t slash = place.rfind('/');
  return slash == std::string::npos ? place : place.substr(slash + 1);
}

const std::optional<LawChoice>* choice_of(const MaterialOptions& m, EffectKind kind) {
  switch (kind) {
    case EffectKind::strength:
      return &m.strength;
    case EffectKind::eos:
      return &m.eos;
    case EffectKind::model:
      return &m.model;
    case EffectKind::viscosity:
      return &m.viscosity;
    case EffectKind::heating:
      return &m.heating;
    case EffectKind::damage:
      return &m.damage;
    default:
      return nullptr;
  }
}

Effect effect_of(const MaterialOptions& m, int index, EffectKind kind) {
  Effect out{.kind = kind, .material = index};
  out.key = fmt::format("materials.{}.{}", m.name, out.name());
  if (const std::optional<LawChoice>* choice = choice_of(m, kind); choice && *choice) {
    out.law = (*choice)->name;
    out.where = place_of((*choice)->where);
  } else if (kind == EffectKind::spall && m.spall_strength) {
    out.law = m.spall_action == SpallAction::fail ? "fail" : "limit";
    out.where = place_of(m.spall_where);
  } else if (kind == EffectKind::rate && m.rate != Rate::truesdell) {
    out.law = kRateNames[static_cast<int>(m.rate)];
    out.where = place_of(m.rate_where);
  }
  return out;
}

/// A coupled model stands for these.
bool in_model(EffectKind kind) {
  return kind == EffectKind::strength || kind == EffectKind::eos || kind == EffectKind::damage ||
         kind == EffectKind::spall;
}

/// The first body of a material that deforms; -1: none.
int body_of(const Scene& scene, int material) {
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    if (scene.bodies[b].material == material && !scene.bodies[b].rigid())
      return static_cast<int>(b);
  return -1;
}

LawChoice plain_law(const char* family, const char* name) {
  LawChoice out;
  out.name = name;
  out.law = find_law(family, name);
  for (const ParameterInfo& p : catalogue()[static_cast<std::size_t>(out.law)].parameters)
    out.values.push_back(p.fallback);
  return out;
}

/// Takes an effect away; false where the rest of the material cannot stand without it.
bool take_away(MaterialOptions& m, EffectKind kind) {
  switch (kind) {
    case EffectKind::viscosity:
      m.viscosity.reset();
      return true;
    case EffectKind::heating:
      m.heating.reset();
      return true;
    case EffectKind::damage:
      m.damage.reset();
      m.failure = FailureAction::strength_loss;
      return true;
    case EffectKind::spall:
      m.spall_strength.reset();
      if (!m.damage) m.failure = FailureAction::strength_loss;
      return true;
    case EffectKind::rate:
      m.rate = Rate::truesdell;
      return true;
    case EffectKind::strength: {
      const LawInfo& law = catalogue()[static_cast<std::size_t>(m.strength->law)];
      if (law.whole_stress || !law.yields) return false;
      m.strength = plain_law("strength", "elastic");
      return true;
    }
    case EffectKind::eos: {
      // Only the two that may stand for one another; a temperature may be a law's of the other.
      if (!m.eos->name.starts_with("mie_gruneisen")) return false;
      if (m.heating && catalogue()[static_cast<std::size_t>(m.heating->law)].needs_eos)
        return false;
      const double K = bulk_modulus_at_rest(m);
      m.eos = plain_law("eos", "linear");
      m.eos->values.at(0) = K;
      return true;
    }
    default:
      return false;
  }
}

}  // namespace

std::vector<Effect> effects_of(const Scene& scene) {
  std::vector<Effect> out;
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    if (body_of(scene, static_cast<int>(m)) < 0) continue;
    const MaterialOptions& material = scene.materials[m];
    for (const EffectKind kind : kOfMaterial)
      if (!(material.model ? in_model(kind) : kind == EffectKind::model))
        out.push_back(effect_of(material, static_cast<int>(m), kind));
  }
  Effect contact{.kind = EffectKind::contact, .key = "contact"};
  if (scene.contact.active) {
    contact.law = scene.contact.normal == ContactNormal::volume_gradient ? "volume_gradient"
                                                                         : "logistic_regression";
    contact.where = place_of(scene.contact.where);
  }
  out.push_back(contact);
  return out;
}

EffectCosts::EffectCosts(const Scene& scene, IsaLevel level) : scene_{scene} {
  for (const Effect& effect : effects_of(scene))
    if (effect.material >= 0) compare(effect, level);
}

std::shared_ptr<StageTimer> EffectCosts::add_timer(const Scene& scene, int material,
                                                   IsaLevel level) {
  timers_.push_back({material, std::make_shared<StageTimer>(std::make_shared<const Scene>(scene),
                                                            body_of(scene, material), level)});
  return timers_.back().timer;
}

void EffectCosts::compare(const Effect& effect, IsaLevel level) {
  const auto own = std::find_if(timers_.begin(), timers_.end(),
                                [&](const Timer& t) { return t.material == effect.material; });
  std::shared_ptr<StageTimer> with =
      own == timers_.end() ? add_timer(scene_, effect.material, level) : own->timer;
  if (!effect.on()) return;
  Scene other = scene_;
  MaterialOptions& m = other.materials[static_cast<std::size_t>(effect.material)];
  if (effect.kind == EffectKind::strength && (m.damage || m.heating)) {
    // Elastic matter neither breaks nor heats: the law is compared alone.
    take_away(m, EffectKind::damage);
    take_away(m, EffectKind::heating);
    with = add_timer(other, effect.material, level);
  }
  if (take_away(m, effect.kind))
    pairs_.push_back(
        {effect.kind, effect.material, with, add_timer(other, effect.material, level)});
}

void EffectCosts::look(const Simulation& sim) {
  constexpr int kLooks = 16;
  if (sim.time() < next_ || sim.steps() == 0) return;
  next_ = sim.time() + scene_.time.end / kLooks;
  ++turn_;
  std::optional<PointSample> sample;
  int of = -1;
  for (const Timer& t : timers_) {
    if (t.material != of) sample = sample_points(sim, body_of(scene_, t.material), turn_);
    of = t.material;
    if (sample) t.timer->measure(*sample);
  }
}

void EffectCosts::fill(std::vector<Effect>& effects) const {
  for (Effect& effect : effects)
    for (const Pair& pair : pairs_)
      if (pair.kind == effect.kind && pair.material == effect.material) {
        effect.bytes = pair.with->bytes_per_point() - pair.without->bytes_per_point();
        effect.nanoseconds = pair.with->nanoseconds() - pair.without->nanoseconds();
      }
}

double EffectCosts::stages(int material) const {
  for (const Timer& t : timers_)
    if (t.material == material) return t.timer->nanoseconds();
  return std::numeric_limits<double>::quiet_NaN();
}

EffectReport report_effects(const Scene& scene, const EffectCosts& costs,
                            const std::string& results) {
  EffectReport out;
  out.effects = effects_of(scene);
  costs.fill(out.effects);
  add_influence(scene, results, out.effects);
  out.sentences = advise(scene, out.effects);
  for (int m = 0; m < static_cast<int>(scene.materials.size()); ++m)
    out.stages.push_back(costs.stages(m));
  return out;
}

EffectReport report_run(const Simulation& sim, const EffectCosts& costs, const std::string& results,
                        double point_steps) {
  EffectReport report = report_effects(sim.scene(), costs, results);
  double all = 0;
  for (std::size_t i = 0; i < phase_names.size(); ++i)
    all += sim.stepper().seconds(static_cast<Phase>(i));
  if (!(all > 0 && point_steps > 0)) return report;
  const double each = 1e9 * threads() / point_steps;
  report.step = each * all;
  for (Effect& effect : report.effects)
    if (effect.kind == EffectKind::contact && effect.on())
      effect.nanoseconds = each * sim.stepper().seconds(Phase::contact);
  return report;
}

}  // namespace krater
