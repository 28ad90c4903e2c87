// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/app/card_doctor.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "krater/materials/catalogue.hpp"

namespace krater {

namespace {

/// Handbook values at room temperature (CRC Handbook of Chemistry and Physics; the alloys' from
/// Johnson and Cook 1983). Alloys of the same density lie within the tolerances below.
struct Metal {
  const char* name;
  double density, cp, T_melt;
};
constexpr Metal kMetals[] = {
    {"magnesium", 1740, 1023, 923},
    {"beryllium", 1845, 1825, 1560},
    {"aluminium", 2700, 897, 933},
    {"titanium", 4510, 523, 1941},
    {"zinc", 7140, 388, 693},
    {"tin", 7290, 227, 505},
    {"iron or steel", 7850, 449, 1811},
    {"brass", 8520, 385, 1189},
    {"nickel", 8900, 444, 1728},
    {"copper", 8960, 385, 1358},
    {"molybdenum", 10220, 251, 2896},
    {"silver", 10490, 235, 1235},
    {"lead", 11340, 129, 601},
    {"tantalum", 16650, 140, 3290},
    {"tungsten alloy", 17000, 134, 1723},
    {"uranium alloy", 18600, 117, 1473},
    {"uranium", 19050, 116, 1408},
    {"gold", 19300, 129, 1337},
    {"tungsten", 19300, 132, 3695},
};
constexpr double kSameDensity = 0.03, kSameModulus = 0.05, kSameHeat = 0.2, kSameMelting = 0.25;

bool near(double a, double b, double tolerance) { return std::fabs(a - b) <= tolerance * b; }

void check_moduli(const MaterialOptions& m, std::vector<std::string>& doubts) {
  const double K = bulk_modulus_at_rest(m);
  if (!(K > 0)) return;
  if (m.bulk_modulus && !near(*m.bulk_modulus, K, kSameModulus))
    doubts.push_back(fmt::format(
        "the elastic constants give K = {:.4g} GPa, the equation of state rho0 c0^2 = {:.4g} GPa "
        "({:+.1f} %); the equation of state is what runs",
        1e-9 * *m.bulk_modulus, 1e-9 * K, 100 * (K / *m.bulk_modulus - 1)));
  const double G = m.shear_modulus;
  const double nu = (3 * K - 2 * G) / (2 * (3 * K + G));
  if (G > 0 && nu < 0)
    doubts.push_back(
        fmt::format("G = {:.4g} GPa with rho0 c0^2 = {:.4g} GPa is a Poisson's ratio of {:.2f}",
                    1e-9 * G, 1e-9 * K, nu));
}

void check_temperatures(const MaterialOptions& m, std::vector<std::string>& doubts) {
  const double T = m.initial_temperature;
  const std::optional<double> T_ref = parameter(m.strength, "T_ref");
  const std::optional<double> T_melt = parameter(m.strength, "T_melt");
  if (T_melt && *T_melt > 0 && T >= *T_melt)
    doubts.push_back(
        fmt::format("starts molten: initial_temperature {:g} K, T_melt {:g} K", T, *T_melt));
  else if (T_ref && T > *T_ref + 1)
    doubts.push_back(
        fmt::format("starts softened: initial_temperature {:g} K, T_ref {:g} K", T, *T_ref));
  if (T_ref && *T_ref < 100)
    doubts.push_back(fmt::format("T_ref = {:g} K looks like degrees Celsius", *T_ref));
}

/// Specific heat and melting point against every metal of about this density.
void check_handbook(const MaterialOptions& m, std::vector<std::string>& doubts) {
  std::optional<double> cp = parameter(m.heating, "cp");
  if (!cp) cp = parameter(m.heating, "c_v");  // a few per cent apart in solids
  // Of laws with a homologous temperature: Steinberg's T_melt is that of a fit.
  const bool homologous = parameter(m.strength, "T_ref").has_value();
  const double T_melt = homologous ? parameter(m.strength, "T_melt").value_or(0) : 0;
  std::string heats, meltings, other;
  bool cp_known = false, T_known = false;
  for (const Metal& metal : kMetals) {
    const bool same = near(m.density, metal.density, kSameDensity);
    if (cp && !same && near(*cp, metal.cp, 0.03))
      other += fmt::format("{}{}", other.empty() ? "" : ", ", metal.name);
    if (!same) continue;
    heats += fmt::format("{}{} {:g}", heats.empty() ? "" : ", ", metal.name, metal.cp);
    meltings += fmt::format("{}{} {:g}", meltings.empty() ? "" : ", ", metal.name, metal.T_melt);
    cp_known = cp_known || (cp && near(*cp, metal.cp, kSameHeat));
    T_known = T_known || near(T_melt, metal.T_melt, kSameMelting);
  }
  if (heats.empty()) return;
  if (cp && !cp_known)
    doubts.push_back(fmt::format("cp = {:g} J/(kg K) at {:g} kg/m^3; expected {}{}", *cp, m.density,
                                 heats,
                                 other.empty() ? "" : " (that is the value of " + other + ")"));
  if (T_melt > 0 && !T_known)
    doubts.push_back(
        fmt::format("T_melt = {:g} K at {:g} kg/m^3; expected {}", T_melt, m.density, meltings));
}

/// Cold tension has no limit of its own in these.
void check_tension(const MaterialOptions& m, std::vector<std::string>& doubts) {
  if (!m.eos || m.eos->name == "ideal_gas" || m.eos->name.starts_with("jwl")) return;
  if (!m.strength || m.strength->name == "elastic" || m.strength->name == "drucker_prager") return;
  if (m.spall_strength) return;
  const bool offered = std::count(m.unused.begin(), m.unused.end(), "spall_strength") > 0;
  doubts.push_back(std::string{"no spall strength: nothing limits its tension"} +
                   (offered ? "; its card has one (spall_strength: card)" : ""));
}

/// Least fracture strain of Johnson-Cook damage over the triaxialities that a body can reach,
/// temperatures up to melting, and rates up to 1e7 /s; where it is not positive the material has no
/// ductility left, and only eps_f_min keeps the law alive. Each factor is monotone: corners
/// suffice.
void check_fracture_strain(const MaterialOptions& m, std::vector<std::string>& doubts) {
  if (!parameter(m.damage, "D1")) return;
  const auto D = [&](const char* key) { return parameter(m.damage, key).value_or(0); };
  double least = HUGE_VAL, at_chi = 0, at_T = 0, at_rate = 0;
  for (const double chi : {-1.0 / 3.0, 1.5})
    for (const double T : {0.0, 1.0})
      for (const double rate : {1.0, 1e7}) {
        const double logarithm = std::log(std::max(rate / D("epsdot0"), 1.0));
        const double strain = (D("D1") + D("D2") * std::exp(D("D3") * chi)) *
                              (1 + D("D4") * logarithm) * (1 + D("D5") * T);
        // Two negative factors are no ductility either.
        const bool negative = D("D1") + D("D2") * std::exp(D("D3") * chi) <= 0 ||
                              1 + D("D4") * logarithm <= 0 || 1 + D("D5") * T <= 0;
        const double value = negative ? -std::fabs(strain) : strain;
        if (value < least) {
          least = value;
          at_chi = chi;
          at_T = T;
          at_rate = rate;
        }
      }
  if (least <= 0)
    doubts.push_back(fmt::format(
        "the fracture strain is {:.3g} at triaxiality {:.2g}, T* = {:g}, {:.0e} /s: not positive; "
        "eps_f_min = {:g} is what runs there",
        least, at_chi, at_T, at_rate, D("eps_f_min")));
}

}  // namespace

std::optional<double> parameter(const std::optional<LawChoice>& choice, const char* key) {
  if (!choice) return std::nullopt;
  const LawInfo& law = catalogue()[static_cast<std::size_t>(choice->law)];
  for (std::size_t i = 0; i < law.parameters.size(); ++i)
    if (std::strcmp(law.parameters[i].key, key) == 0) return choice->values[i];
  return std::nullopt;
}

double bulk_modulus_at_rest(const MaterialOptions& m) {
  const std::optional<LawChoice>& law = m.eos ? m.eos : m.model;
  if (!law) return 0;
  const double c0 = sound_speed_at_rest(law->law, law->values.data(),
                                        {m.density, m.shear_modulus, m.initial_temperature})
                        .value();
  return m.density * c0 * c0;
}

std::vector<std::string> doubt_constants(const MaterialOptions& material) {
  std::vector<std::string> doubts = doubt_magnitudes(material);
  if (doubts.empty()) check_model(material, doubts);
  return doubts;
}

std::vector<std::string> examine(const MaterialOptions& material) {
  std::vector<std::string> doubts = doubt_magnitudes(material);
  if (!doubts.empty()) return doubts;  // nothing else can be judged
  check_moduli(material, doubts);
  check_temperatures(material, doubts);
  check_handbook(material, doubts);
  check_tension(material, doubts);
  check_fracture_strain(material, doubts);
  check_model(material, doubts);
  return doubts;
}

}  // namespace krater
