// SPDX-License-Identifier: GPL-3.0-or-later
// What the speed v at which bodies meet lets expect of each effect, from above:
//   rise of temperature     v^2/(2 c): all of the kinetic energy is heat where it was
//   plastic strain          rho v^2/(2 Y): all of it is flow
//   tension                 rho c0 v: the wave of the impact, come back from a free side
//   strength of a shock     S v/c0, and one cell's width of a compression is one after h c0/(S v)
//   viscosity of a front    q_lin rho c0 v: c |D| h with the jump v over one cell
// Flow gathers in bands and waves in corners: an effect is called idle only where even
// kGathered times these would not be felt.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "krater/app/card_doctor.hpp"
#include "krater/app/effects.hpp"
#include "krater/app/forecast.hpp"

namespace krater {

namespace {

constexpr double kGathered = 100;    // strains and temperatures of a band over their mean
constexpr double kFocused = 10;      // stresses where waves meet over those of a plane wave
constexpr double kFelt = 0.01;       // a share that is felt
constexpr double kSteepening = 1.5;  // S where the equation of state does not say it
constexpr double kFractureStrain = 0.1;
constexpr const char* kIdle = "cannot be felt";
constexpr const char* kLacking = "lacking";

double yield_at_rest(const MaterialOptions& m) {
  for (const char* key : {"Y", "A", "Y0", "C0"})
    if (const auto value = parameter(m.strength, key)) return *value;
  return 0;
}

struct Expected {
  const MaterialOptions& m;
  const Scene& scene;
  double v, Y, c0;

  double stress() const { return m.density * c0 * v; }
  double strain() const { return 0.5 * m.density * v * v / Y; }
};

std::string idle_heating(const Expected& x) {
  std::optional<double> c = parameter(x.m.heating, "cp");
  if (!c) c = parameter(x.m.heating, "c_v");
  if (!c || !(*c > 0)) return "";
  const double rise = 0.5 * x.v * x.v / *c;
  const double melting = parameter(x.m.strength, "T_melt").value_or(0) - x.m.initial_temperature;
  const double whole = melting > 0 ? melting : x.m.initial_temperature;
  if (kGathered * rise > kFelt * whole) return "";
  return fmt::format("all of the kinetic energy as heat is {:.2g} K of the {:.4g} K {}", rise,
                     whole, melting > 0 ? "to melting" : "at the start");
}

std::string idle_damage(const Expected& x) {
  if (!(x.Y > 0)) return "";
  double fracture = kFractureStrain;
  if (const auto most = parameter(x.m.damage, "eps_max")) fracture = *most;
  if (const auto D1 = parameter(x.m.damage, "D1"))
    fracture = std::max(*D1 + parameter(x.m.damage, "D2").value_or(0), kFelt);
  if (const auto work = parameter(x.m.damage, "W_c")) fracture = *work / x.Y;
  if (kGathered * x.strain() > kFelt * fracture) return "";
  return fmt::format(
      "all of the kinetic energy as flow is a plastic strain of {:.2g}, and the law "
      "breaks at about {:.2g}",
      x.strain(), fracture);
}

std::string idle_spall(const Expected& x) {
  if (kFocused * x.stress() > *x.m.spall_strength) return "";
  return fmt::format(
      "the wave of the impact, rho c0 v, is {:.3g} MPa of the {:.4g} MPa at which "
      "the material parts",
      1e-6 * x.stress(), 1e-6 * *x.m.spall_strength);
}

std::string idle_viscosity(const Expected& x) {
  const double S = parameter(x.m.eos, "S1").value_or(kSteepening);
  const double needs = x.scene.grid.cell * x.c0 / (S * x.v), runs = x.c0 * x.scene.time.end;
  if (!(needs > runs) || S * x.v > kFelt * x.c0) return "";
  const double q = parameter(x.m.viscosity, "q_lin").value_or(0) * x.stress();
  std::string text = fmt::format(
      "a wave steepens to a shock in {:.2g} m and runs {:.2g} m until the end: it only damps "
      "ringing, by up to {:.2g} MPa (q_lin rho c0 v)",
      needs, runs, 1e-6 * q);
  if (x.Y > 0) text += fmt::format(", {:.0f} % of the yield stress", 100 * q / x.Y);
  return text;
}

std::string idle_strength(const Expected& x) {
  if (!(x.Y > 0) || kFocused * x.stress() > x.Y) return "";
  return fmt::format(
      "the wave of the impact, rho c0 v, is {:.3g} MPa of the {:.4g} MPa at which it "
      "flows; strength elastic would do",
      1e-6 * x.stress(), 1e-6 * x.Y);
}

/// Why an effect that is on cannot be felt; empty: it can.
std::string idle(const Expected& x, EffectKind kind) {
  switch (kind) {
    case EffectKind::heating:
      return idle_heating(x);
    case EffectKind::damage:
      return idle_damage(x);
    case EffectKind::spall:
      return idle_spall(x);
    case EffectKind::viscosity:
      return idle_viscosity(x);
    case EffectKind::strength:
      return idle_strength(x);
    default:
      return "";
  }
}

/// What the scene lacks at this speed, after Zukas and Wilbeck; empty: nothing.
std::string lacking(const MaterialOptions& m, EffectKind kind, const Impact& impact) {
  const double fastest = impact.fastest, closing = impact.closing;
  const bool cuts = m.spall_strength || m.damage;
  if (kind == EffectKind::eos && fastest > 500 && m.eos && m.eos->name == "linear")
    return fmt::format(
        "{:.0f} m/s with a linear equation of state; shocks need mie_gruneisen_shock", fastest);
  if (kind == EffectKind::strength && closing > 300 && m.strength && m.strength->name == "elastic")
    return fmt::format(
        "elastic never yields and is meant for small strains; {:.0f} m/s calls for a yield law",
        closing);
  if (kind == EffectKind::viscosity && fastest > 50 && !m.viscosity)
    return "no viscosity block; shocks will ring (add viscosity: {})";
  if (kind == EffectKind::spall && fastest > 100 && m.eos && !cuts)
    return "neither spall_strength nor damage; cold tension has no other limit";
  if (kind != EffectKind::heating) return "";
  if (fastest > 100 && m.strength && m.strength->name == "johnson_cook" && !m.heating)
    return "johnson_cook without heating: no thermal softening";
  if (closing > 2000 && m.heating && m.heating->name == "plastic_work")
    return fmt::format(
        "impact at {:.0f} m/s: plastic_work misses the heat of the shock (src/THEORY.md 8); "
        "heating: {{energy: {{c_v: ...}}}} sees it",
        closing);
  return "";
}

Triple mean_of(const std::vector<Triple>& velocities) {
  Triple mean{};
  for (const Triple& v : velocities)
    for (std::size_t k = 0; k < 3; ++k) mean[k] += v[k] / static_cast<double>(velocities.size());
  return mean;
}

/// Speeds at the start do not say what will move.
bool is_driven(const Scene& scene) {
  bool driven =
      scene.body_force != nullptr || !scene.loads.faces.empty() || !scene.detonators.empty();
  for (const BodyOptions& body : scene.bodies)
    driven = driven || (body.rigid() && body.velocity && body.velocity->depends_on_time());
  for (const MaterialOptions& m : scene.materials)
    driven = driven || (m.eos && (m.eos->name.ends_with("_gas") || m.eos->name.starts_with("jwl")));
  return driven;
}

}  // namespace

Impact impact_of(const Scene& scene) {
  Impact out;
  std::vector<Triple> means;
  for (const BodyOptions& body : scene.bodies) {
    out.fastest = std::max(out.fastest, greatest_speed(scene, body));
    means.push_back(mean_of(sampled_velocities(scene, body)));
  }
  out.closing = out.fastest;
  for (std::size_t a = 0; a < means.size(); ++a) {
    const Triple& v = means[a];
    for (std::size_t b = 0; b < a; ++b)
      out.closing = std::max(
          out.closing, std::hypot(v[0] - means[b][0], v[1] - means[b][1], v[2] - means[b][2]));
    for (std::size_t k = 0; k < 3; ++k)
      for (const Boundary& side : scene.grid.boundary[k]) {
        if (side.kind == BoundaryKind::symmetry)
          out.closing = std::max(out.closing, 2 * std::fabs(v[k]));
        if (side.drives()) out.closing = std::max(out.closing, std::fabs(v[k] - side.velocity[k]));
      }
  }
  out.driven = is_driven(scene);
  return out;
}

std::vector<std::string> advise(const Scene& scene, std::vector<Effect>& effects) {
  const Impact impact = impact_of(scene);
  std::vector<std::string> sentences;
  for (Effect& effect : effects) {
    if (effect.material < 0) continue;
    const MaterialOptions& m = scene.materials[static_cast<std::size_t>(effect.material)];
    if (const std::string text = lacking(m, effect.kind, impact); !text.empty()) {
      effect.word = kLacking;
      sentences.push_back(m.name + ": " + text);
    } else if (effect.on() && !impact.driven && impact.closing > 0 && (m.eos || m.model)) {
      const Expected x{m, scene, impact.closing, yield_at_rest(m),
                       std::sqrt(bulk_modulus_at_rest(m) / m.density)};
      const std::string why = idle(x, effect.kind);
      if (why.empty()) continue;
      effect.word = kIdle;
      sentences.push_back(fmt::format("{}: {} cannot be felt at {:.3g} m/s: {}", m.name,
                                      effect.name(), impact.closing, why));
    }
  }
  return sentences;
}

}  // namespace krater
