// SPDX-License-Identifier: GPL-3.0-or-later
// Magnitudes: numbers of another system of units (kg-mm-ms, g-cm-us, t-mm-s; GPa, km/s, mm or us
// without their unit) are wrong by powers of ten that no material and no impact allow.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "krater/app/card_doctor.hpp"
#include "krater/app/forecast.hpp"
#include "krater/materials/catalogue.hpp"

namespace krater {

namespace {

enum Kind : unsigned { solid = 1, fluid = 2, gas = 4, explosive = 8, condensed = 11, any = 15 };

/// Where a number of its kind lies, the widest, and what is usual.
struct Magnitude {
  unsigned kinds;
  const char* key;   ///< "": every other of this unit
  const char* unit;  ///< SI, as declared
  double least, most, usual;
};

// The first that fits counts. Foams to uranium; gels to diamond; annealed lead to hard tool steel.
constexpr Magnitude kMagnitudes[] = {
    {solid, "", "kg/m^3", 5, 25e3, 5e3},
    {fluid, "", "kg/m^3", 50, 25e3, 1e3},
    {gas, "", "kg/m^3", 1e-4, 5e3, 1},
    {explosive, "", "kg/m^3", 100, 3e3, 1700},
    {any, "shear_modulus", "Pa", 1e3, 2e12, 5e10},
    {any, "bulk_modulus", "Pa", 1e3, 2e12, 1e11},
    {any, "spall_strength", "Pa", 1e4, 1e11, 2e9},
    {any, "initial_temperature", "K", 50, 1e5, 293},
    {explosive, "A", "Pa", 1e9, 5e12, 5e11},
    {explosive, "B", "Pa", 1e7, 1e12, 7e9},
    {explosive, "p_CJ", "Pa", 5e8, 1e11, 2.5e10},
    {explosive, "D", "m/s", 1e3, 1.2e4, 7e3},
    {explosive, "bulk_modulus", "Pa", 1e8, 1e11, 1e10},
    {any, "E0", "Pa", 1e7, 5e10, 7e9},
    {any, "initial_pressure", "Pa", 1e-3, 1e12, 1e5},
    {any, "a0", "Pa", 1e6, 2e12, 1e11},
    {any, "b0", "Pa", 1e6, 5e12, 1e11},
    {any, "c0", "Pa", 1e6, 2e13, 1e11},
    {any, "W_c", "Pa", 1e5, 1e11, 1e9},
    {any, "c1", "Pa", 1e-3, 2e12, 1e3},  // osborn's, of strength that p = 1 Pa adds
    {any, "", "Pa", 1e3, 2e12, 4e8},
    {any, "c0", "m/s", 300, 15e3, 4e3},
    {any, "", "J/kg", 1e4, 1e10, 1e7},
    {any, "", "J/(kg.K)", 50, 2e4, 500},
    {any, "T_melt", "K", 150, 5e3, 1500},
    {any, "aggregate_size", "m", 1e-4, 0.15, 0.01},  // mortar to mass concrete
    {any, "", "J/m^2", 0.5, 1e6, 100},
    {any, "crush_compression", "1", 1e-5, 0.05, 1e-3},
    {any, "lock_compression", "1", 1e-3, 1.5, 0.1},  // concrete to foamed concrete
    {any, "epsdot0", "1/s", 1e-7, 1e9, 1},
    {any, "A", "1/Pa", 1e-14, 1e-8, 3e-11},
    {any, "", "1/K", 1e-7, 0.1, 1e-3},
    {any, "S1", "1", 0.1, 4, 1.4},
    {any, "gamma0", "1", 0.05, 5, 2},
    {any, "gamma", "1", 1.01, 10, 1.4},
    {solid, "n", "1", 0.01, 3, 0.3},
    {solid, "m", "1", 0.05, 12, 1},
    {solid, "C", "1", 0, 0.6, 0.01},
    {explosive, "R1", "1", 1, 20, 4.5},
    {explosive, "R2", "1", 0.1, 10, 1.2},
    {explosive, "omega", "1", 0.01, 1.5, 0.3},
    {any, "eps_max", "1", 1e-4, 20, 0.5},
    {any, "q_lin", "1", 0, 3, 0.3},
    {any, "q_quad", "1", 0, 20, 2},
};

struct OtherUnit {
  const char* unit;  ///< SI, as declared
  const char* name;
  double factor;  ///< SI per one of it
};
constexpr OtherUnit kOtherUnits[] = {
    {"kg/m^3", "g/cm^3", 1e3},
    {"kg/m^3", "kg/mm^3", 1e9},
    {"kg/m^3", "t/mm^3", 1e12},
    {"kg/m^3", "g/m^3", 1e-3},
    {"Pa", "GPa", 1e9},
    {"Pa", "MPa", 1e6},
    {"Pa", "Mbar", 1e11},
    {"Pa", "kbar", 1e8},
    {"Pa", "kPa", 1e3},
    {"Pa", "mPa", 1e-3},
    {"m/s", "km/s", 1e3},
    {"m/s", "mm/s", 1e-3},
    {"m/s", "cm/us", 1e4},
    {"J/kg", "kJ/g", 1e6},
    {"J/kg", "mJ/t", 1e-6},
    {"J/kg", "Mbar cm^3/g", 1e8},
    {"J/kg", "kJ/kg", 1e3},
    {"J/(kg.K)", "J/(g K)", 1e3},
    {"J/(kg.K)", "mJ/(t K)", 1e-6},
    {"J/(kg.K)", "Mbar cm^3/(g K)", 1e8},
    {"1/s", "1/us", 1e6},
    {"1/s", "1/ms", 1e3},
    {"1/Pa", "1/Mbar", 1e-11},
    {"1/Pa", "1/GPa", 1e-9},
    {"1/Pa", "1/MPa", 1e-6},
    {"1", "percent", 0.01},
    {"J/m^2", "N/mm", 1e3},
    {"s", "us", 1e-6},
    {"s", "ms", 1e-3},
    {"m", "mm", 1e-3},
    {"m", "um", 1e-6},
};

/// "; GPa meant? (4.6e+10 Pa)": the unit that brings the value nearest to what is usual, if to less
/// than a factor of 100.
std::string other_unit(double value, const char* unit, double usual) {
  const OtherUnit* best = nullptr;
  double least = std::log(100.0);
  for (const OtherUnit& other : kOtherUnits) {
    const double off = std::fabs(std::log(std::fabs(value) * other.factor / usual));
    if (std::strcmp(other.unit, unit) != 0 || off >= least) continue;
    best = &other;
    least = off;
  }
  if (!best) return "";
  return fmt::format("; {} meant? ({:.4g} {})", best->name, value * best->factor, unit);
}

unsigned kind_of(const MaterialOptions& m) {
  if (m.eos && m.eos->name == "ideal_gas") return gas;
  if (m.eos && m.eos->name.starts_with("jwl")) return explosive;
  return m.strength || m.model || m.shear_modulus > 0 ? solid : fluid;
}

std::string name_of_kind(unsigned kind) {
  return kind == solid   ? "a solid"
         : kind == gas   ? "a gas"
         : kind == fluid ? "a liquid"
                         : "an explosive";
}

/// A number that has no business where it is; zero switches a term off, and a default is ours.
struct Examined {
  const char* key;
  const char* unit;
  double value;
};

void doubt(const Examined& number, unsigned kind, std::vector<std::string>& doubts) {
  for (const Magnitude& m : kMagnitudes) {
    if ((m.kinds & kind) == 0 || std::strcmp(m.unit, number.unit) != 0) continue;
    if (*m.key != '\0' && std::strcmp(m.key, number.key) != 0) continue;
    const double size = std::fabs(number.value);
    if (size == 0 || (size >= m.least && size <= m.most)) return;
    const bool pure = std::strcmp(m.unit, "1") == 0;
    std::string guess = other_unit(number.value, number.unit, m.usual);
    if (std::strcmp(m.unit, "K") == 0 && number.value < 100 && m.usual < 300)
      guess = "; degrees Celsius? (write " + fmt::format("{:g} degC)", number.value);
    doubts.push_back(fmt::format("{} = {:.6g}{}{} is not of {}, {:g} to {:g}{}", number.key,
                                 number.value, pure ? "" : " ", pure ? "" : number.unit,
                                 name_of_kind(kind), m.least, m.most, guess));
    return;
  }
}

/// Verification problems take soft elastic bodies; their numbers are judged by the speeds.
bool ideal(const MaterialOptions& m) {
  const bool elastic =
      !m.strength || m.strength->name == "elastic" || m.strength->name == "neo_hookean";
  return elastic && !m.model && (!m.eos || m.eos->name == "linear");
}

std::optional<double> bulk_given(const MaterialOptions& m) {
  if (m.eos && m.eos->name == "linear") return m.eos->values.at(0);
  return m.bulk_modulus;
}

/// Longitudinal wave speed at rest [m/s].
double wave_speed(const MaterialOptions& m) {
  const double K = m.eos || m.model ? bulk_modulus_at_rest(m) : m.bulk_modulus.value_or(0);
  return std::sqrt((K + 4.0 / 3.0 * m.shear_modulus) / m.density);
}

void doubt_speed(const std::string& what, double speed, std::vector<std::string>& doubts) {
  constexpr double fastest = 1e5, usual = 1e3;
  if (speed > fastest)
    doubts.push_back(fmt::format("{} moves at {:.4g} m/s, faster than any impact{}", what, speed,
                                 other_unit(speed, "m/s", usual)));
}

/// Length of the domain's part of a body: the longest along the grid's axes.
double length_of(const Scene& scene, const BodyOptions& body) {
  const int dim = dimension(scene.frame);
  const Box box =
      intersection(body.solid->extent(scene.frame), {scene.grid.min, scene.grid.max}, dim);
  double length = 0;
  for (int a = 0; a < dim; ++a) length = std::max(length, box.length(a));
  return length;
}

}  // namespace

std::vector<std::string> doubt_magnitudes(const MaterialOptions& m) {
  std::vector<std::string> doubts;
  const unsigned kind = kind_of(m);
  doubt({"density", "kg/m^3", m.density}, kind, doubts);
  if (m.bare) return doubts;
  if (!ideal(m)) doubt({"shear_modulus", "Pa", m.shear_modulus}, kind, doubts);
  if (!ideal(m)) doubt({"bulk_modulus", "Pa", bulk_given(m).value_or(0)}, kind, doubts);
  doubt({"initial_temperature", "K", m.initial_temperature}, kind, doubts);
  doubt({"spall_strength", "Pa", m.spall_strength.value_or(0)}, kind, doubts);
  for (const std::optional<LawChoice>* choice :
       {&m.eos, &m.strength, &m.damage, &m.model, &m.viscosity, &m.heating}) {
    if (!*choice || (*choice)->name == "linear" || (*choice)->name == "neo_hookean") continue;
    const LawInfo& law = catalogue()[static_cast<std::size_t>((*choice)->law)];
    for (std::size_t i = 0; i < law.parameters.size(); ++i) {
      const ParameterInfo& p = law.parameters[i];
      const double value = (*choice)->values[i];
      if (!p.words && value != p.fallback) doubt({p.key, p.unit, value}, kind, doubts);
    }
  }
  const double stiffness = m.eos || m.model ? m.shear_modulus / bulk_modulus_at_rest(m) : 1;
  if (doubts.empty() && m.shear_modulus > 0 && (stiffness < 1e-6 || stiffness > 10))
    doubts.push_back(
        fmt::format("G = {:.4g} Pa is {:.2g} of rho0 c0^2 = {:.4g} Pa: one of them is in "
                    "another unit",
                    m.shear_modulus, stiffness, m.shear_modulus / stiffness));
  return doubts;
}

std::vector<std::string> doubt_scene(const Scene& scene) {
  constexpr double longest = 3, longest_fluid = 300, shortest = 1e-7;  // [m]
  constexpr double most_transits = 2e4, most_mach = 100;
  std::vector<std::string> doubts;
  double transit = 0, slowest = 0;
  for (const BodyOptions& body : scene.bodies) {
    const MaterialOptions& m = scene.materials[static_cast<std::size_t>(body.material)];
    const double length = length_of(scene, body), speed = greatest_speed(scene, body);
    const double c = m.bare ? 0 : wave_speed(m);
    const std::string name = "body " + body.name;
    doubt_speed(name, speed, doubts);
    if (length > (kind_of(m) == solid ? longest : longest_fluid) || length < shortest)
      doubts.push_back(fmt::format("{} is {:.4g} m long{}", name, length,
                                   length > 1 ? other_unit(length, "m", 0.03) : ""));
    if (c > 0) transit = std::max(transit, length / c);
    if (c > 0) slowest = slowest > 0 ? std::min(slowest, c) : c;
    if (c > 0 && speed > most_mach * c)
      doubts.push_back(
          fmt::format("{} moves at {:.4g} m/s, {:.2g} times the wave speed of its material, {:.3g} "
                      "m/s: are its "
                      "moduli in Pa, its density in kg/m^3?",
                      name, speed, speed / c, c));
  }
  for (const auto& axis : scene.grid.boundary)
    for (const Boundary& side : axis)
      for (const double v : side.velocity)
        doubt_speed("a side of the domain", std::fabs(v), doubts);
  if (transit > 0 && scene.time.end > most_transits * transit)
    doubts.push_back(fmt::format(
        "time.end = {:.4g} s is {:.2g} times what a wave needs through the largest body{}",
        scene.time.end, scene.time.end / transit, other_unit(scene.time.end, "s", 20 * transit)));
  if (slowest > 0 && transit > 0 &&
      scene.time.end < 0.1 * scene.time.cfl * scene.grid.cell / slowest)
    doubts.push_back(
        fmt::format("time.end = {:.4g} s is shorter than one time step", scene.time.end));
  for (const double friction : scene.contact.friction)
    if (friction > 2) {
      doubts.push_back(fmt::format("a friction coefficient of {:g}", friction));
      break;
    }
  return doubts;
}

}  // namespace krater
