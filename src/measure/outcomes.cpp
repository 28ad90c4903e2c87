// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/measure/outcomes.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "krater/core/errors.hpp"
#include "krater/measure/measurements.hpp"
#include "krater/scene/yaml/expression.hpp"

namespace krater {

namespace {

using When = StopOptions::When;

double length(const Triple& v) { return std::hypot(v[0], v[1], v[2]); }

/// Of the bodies at the start, by their means.
double fastest_body(const Simulation& sim) {
  double fastest = 0;
  for (std::size_t b = 0; b < sim.bodies().size(); ++b) {
    const Totals t = sim.totals(static_cast<int>(b));
    if (t.mass > 0) fastest = std::max(fastest, length(t.momentum) / t.mass);
  }
  return fastest;
}

/// Points are within a cell of an open side: what is left would tell another velocity.
bool leaves(const BodyPoints& points, const MeasureContext& context) {
  const PointBox box = box_of(points);
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension(context.frame)); ++a)
    if ((context.boundary[a][0] == BoundaryKind::open && box.low[a] < context.min[a] + context.h) ||
        (context.boundary[a][1] == BoundaryKind::open && box.high[a] > context.max[a] - context.h))
      return true;
  return false;
}

/// "rod perforated plate"
std::string fate_sentence(Fate fate, bool broken, const std::string& target) {
  static constexpr std::array phrases{"still moves at ", "perforated ", "was stopped by ",
                                      "ricocheted off ", "missed "};
  return (broken ? " broke up and " : " ") + (phrases[static_cast<std::size_t>(fate)] + target);
}

const GatherNeeds kNeeds{.velocity = true, .pieces = true};

const std::string& body_name(const Scene& scene, int b) {
  return scene.bodies[static_cast<std::size_t>(b)].name;
}

}  // namespace

Outcomes::Outcomes(const Simulation& sim, const std::vector<Quantity>& columns)
    : scene_{sim.scene()} {
  for (const OutcomeOptions& o : scene_.outcomes) {
    Watched w;
    const BodyPoints projectile = gather_points(sim, {o.projectile}, kNeeds);
    const BodyPoints target = o.target < 0 ? BodyPoints{} : gather_points(sim, {o.target}, kNeeds);
    w.start = outcome_start(projectile, target, measure_context(sim, {o.projectile}));
    if (o.target >= 0 && w.start.speed == 0)
      throw InputError(
          fmt::format("{}: {} and {} have the same velocity at the start: neither meets "
                      "the other",
                      o.where, body_name(scene_, o.projectile), body_name(scene_, o.target)));
    if (w.start.speed == 0) w.start.speed = fastest_body(sim);
    watched_.push_back(std::move(w));
    take(sim, watched_.size() - 1);
  }
  if (scene_.stop.when == When::energy && !(sim.audit().initial_kinetic > 0))
    throw InputError(scene_.stop.where +
                     ": nothing moves at the start, so the kinetic energy has "
                     "nothing to be compared with; use an expression, as "
                     "kinetic_energy < 5");
  if (scene_.stop.when != When::expression) return;
  std::vector<std::string> names;
  for (const Quantity& column : columns) names.push_back(column.name);
  try {
    condition_ = make_table_function(scene_.stop.expression, names);
  } catch (const InputError& e) {
    throw InputError(scene_.stop.where + ": " + e.what());
  }
}

/// The next of the times k * every; none where every step is looked at.
void Outcomes::schedule(std::size_t i, double now) {
  const double every = scene_.outcomes[i].every;
  if (every > 0) watched_[i].next = (std::floor(now / every * (1 + 1e-12)) + 1) * every;
}

void Outcomes::take(const Simulation& sim, std::size_t i) {
  const OutcomeOptions& o = scene_.outcomes[i];
  Watched& w = watched_[i];
  schedule(i, sim.time());
  const BodyPoints points = gather_points(sim, {o.projectile}, kNeeds);
  const MeasureContext context = measure_context(sim, {o.projectile});
  const bool first = w.looks.empty();
  if (points.count() == 0 || (!first && leaves(points, context))) return;  // it stays what it was
  const OutcomeState state = outcome_state(points, context, w.start);
  OutcomeLook look{sim.time(), state.velocity, state.velocity, 0};
  if (o.target >= 0) {
    const Totals target = sim.totals(o.target);
    for (std::size_t a = 0; a < 3 && target.mass > 0; ++a)
      if (!w.start.mirrored[a]) look.w[a] -= target.momentum[a] / target.mass;
  }
  w.looks.push_back(look);
  const Settling settling = settling_of(w.looks, w.start, o.tolerance);
  w.looks.back().fate = static_cast<double>(fate_of(state, look.w, settling, w.start, o.tolerance));
}

bool Outcomes::judge(const Simulation& sim, const std::vector<Quantity>& row) const {
  const StopOptions& stop = scene_.stop;
  const auto i = static_cast<std::size_t>(std::max(stop.outcome, 0));
  switch (stop.when) {
    case When::never:
      return false;
    case When::settled:
      return settled(watched_[i].looks, watched_[i].start, scene_.outcomes[i].tolerance);
    case When::perforated:
      return watched_[i].looks.back().fate == static_cast<double>(Fate::perforated);
    case When::energy:
      return sim.audit().kinetic < stop.share * sim.audit().initial_kinetic;
    case When::expression:
      break;
  }
  std::vector<double> values;
  for (const Quantity& column : row) values.push_back(column.value);
  return !values.empty() && condition_(values) > 0;
}

bool Outcomes::due(double time) const {
  return std::any_of(watched_.begin(), watched_.end(),
                     [time](const Watched& w) { return time >= w.next; });
}

bool Outcomes::look(const Simulation& sim, const std::vector<Quantity>& row) {
  bool looked = false;
  for (std::size_t i = 0; i < watched_.size(); ++i) {
    if (sim.time() < watched_[i].next) continue;
    take(sim, i);
    looked = looked || scene_.stop.outcome == static_cast<int>(i);
  }
  const When when = scene_.stop.when;
  if (looked || when == When::energy || when == When::expression)
    answered_ = answered_ || judge(sim, row);
  return answered_;
}

Json Outcomes::describe(const Simulation& sim, std::size_t i) {
  const OutcomeOptions& o = scene_.outcomes[i];
  const Watched& w = watched_[i];
  const Settling settling = settling_of(w.looks, w.start, o.tolerance);
  const OutcomeLook& last = w.looks.back();
  const auto fate = static_cast<Fate>(static_cast<int>(last.fate));
  const BodyPoints points = gather_points(sim, {o.projectile}, kNeeds);
  const OutcomeState state = outcome_state(points, measure_context(sim, {o.projectile}), w.start);
  const bool broken = points.count() > 0 && state.broken();
  const std::string projectile = body_name(scene_, o.projectile);
  Json j;
  j["projectile"] = Json::of(projectile);
  std::string sentence = projectile;
  if (o.target >= 0) {
    const std::string target = body_name(scene_, o.target);
    j["target"] = Json::of(target);
    j["outcome"] = Json::of(broken ? "broken_up" : name_of(fate));
    j["main_piece_outcome"] = Json::of(name_of(fate));
    j["outcome_since"] = Json::of(fate_since(w.looks));
    sentence += fate_sentence(fate, broken, target);
  }
  const bool answer = settled(w.looks, w.start, o.tolerance);
  j["settled"] = Json::of(answer);
  j["settled_time"] = answer ? Json::of(settling.since) : Json::null();
  Json& velocity = j["residual_velocity"];
  for (int a = 0; a < dimension(scene_.frame); ++a)
    velocity[std::string{axis_name(scene_.frame, a)}] =
        points.count() > 0 ? Json::of(state.velocity[static_cast<std::size_t>(a)]) : Json::null();
  j["residual_speed"] = points.count() > 0 ? Json::of(length(state.velocity)) : Json::null();
  j["relative_speed"] = Json::of(length(last.w));
  j["drift"] = Json::of(settling.drift);
  j["drift_time"] = Json::of(last.time - settling.since);
  j["last_seen"] = Json::of(last.time);
  j["mass_left"] = Json::of(state.mass / w.start.mass);
  j["main_piece"] = Json::of(state.main);
  if (o.target >= 0) {
    j["mass_through"] = Json::of(state.through);
    j["mass_before"] = Json::of(state.before);
  }
  sentence +=
      answer ? fmt::format(", settled at {:.4g} s", settling.since) : std::string{", not settled"};
  sentences_.push_back(sentence + fmt::format(": {:.4g} m/s, drift {:.2g} m/s in {:.2g} s",
                                              length(state.velocity), settling.drift,
                                              last.time - settling.since));
  return j;
}

void Outcomes::summarize(const Simulation& sim, Json& summary) {
  sentences_.clear();
  if (answered_) {
    summary["stopped"]["when"] = Json::of(answer());
    summary["stopped"]["time"] = Json::of(sim.time());
  }
  if (sim.broken()) return;
  for (std::size_t i = 0; i < watched_.size(); ++i)
    summary["outcomes"][scene_.outcomes[i].name] = describe(sim, i);
}

void Outcomes::save(Checkpoint& checkpoint) const {
  for (std::size_t i = 0; i < watched_.size(); ++i) {
    const std::string name = "outcomes/" + scene_.outcomes[i].name;
    std::vector<double> x;
    for (const OutcomeLook& look : watched_[i].looks)
      x.insert(x.end(), {look.time, look.v[0], look.v[1], look.v[2], look.w[0], look.w[1],
                         look.w[2], look.fate});
    checkpoint.blobs.push_back({name + "/looks", {x.size()}, std::move(x), {}, {}});
    checkpoint.blobs.push_back({name + "/options", {}, {}, {}, scene_.outcomes[i].identity});
  }
  if (answered_) checkpoint.blobs.push_back({"answered", {}, {}, {}, scene_.stop.text});
}

void Outcomes::restore(const Checkpoint& checkpoint) {
  const CheckpointBlob* answered = checkpoint.find("answered");
  answered_ = answered != nullptr && answered->text == scene_.stop.text;
  for (std::size_t i = 0; i < watched_.size(); ++i) {
    const std::string name = "outcomes/" + scene_.outcomes[i].name;
    const CheckpointBlob *looks = checkpoint.find(name + "/looks"),
                         *options = checkpoint.find(name + "/options");
    if (looks == nullptr || options == nullptr || options->text != scene_.outcomes[i].identity)
      continue;
    Watched& w = watched_[i];
    w.looks.clear();
    const std::vector<double>& x = looks->doubles;
    for (std::size_t k = 0; k + 7 < x.size(); k += 8)
      w.looks.push_back(
          {x[k], {x[k + 1], x[k + 2], x[k + 3]}, {x[k + 4], x[k + 5], x[k + 6]}, x[k + 7]});
    if (!w.looks.empty()) schedule(i, w.looks.back().time);
  }
}

}  // namespace krater
