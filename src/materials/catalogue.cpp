// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/materials/catalogue.hpp"

#include "krater/materials/law_list.hpp"

namespace krater {

namespace {

template <class Law>
LawInfo describe() {
  LawInfo info{.family = kFamilyNames[static_cast<int>(Law::family)],
               .name = Law::name,
               .parameters = {},
               .equation = Law::equation,
               .reference = Law::reference,
               .needs_shear_modulus = false,
               .whole_stress = false,
               .yields = Yielding<Law>,
               .needs_eos = false};
  if constexpr (parameter_count < Law >> 0) {
    for (const Parameter<Law>& p : Law::parameters) info.parameters.push_back(p.info);
  }
  if constexpr (requires { Law::needs_shear_modulus; }) {
    info.needs_shear_modulus = Law::needs_shear_modulus;
  }
  if constexpr (requires { Law::needs_eos; }) info.needs_eos = Law::needs_eos;
  if constexpr (requires { Law::whole_stress; }) info.whole_stress = Law::whole_stress;
  return info;
}

template <class Law>
const char* problem_of(const double* values, const MaterialConstants& constants) {
  if constexpr (requires(const Law& law) { law.problem(); }) {
    return make_law<Law>(values, constants).problem();
  } else {
    return nullptr;
  }
}

template <class Law>
bool degrades_of(const double* values, const MaterialConstants& constants) {
  if constexpr (requires(const Law& law) { law.degrades(); }) {
    return make_law<Law>(values, constants).degrades();
  } else {
    return false;
  }
}

template <class Law>
std::optional<double> thermal_energy_of(const double* values, const MaterialConstants& constants) {
  if constexpr (requires(const Law& law) { law.thermal_energy(); }) {
    return make_law<Law>(values, constants).thermal_energy();
  } else {
    return std::nullopt;
  }
}

using ThermalEnergy = std::optional<double> (*)(const double*, const MaterialConstants&);
using Degrades = bool (*)(const double*, const MaterialConstants&);
using Problem = const char* (*)(const double*, const MaterialConstants&);

template <class... Laws>
std::vector<LawInfo> describe_all(LawList<Laws...>) {
  return {describe<Laws>()...};
}
template <class... Laws>
std::vector<Problem> problems_of(LawList<Laws...>) {
  return {&problem_of<Laws>...};
}
template <class... Laws>
std::vector<ThermalEnergy> thermal_energies(LawList<Laws...>) {
  return {&thermal_energy_of<Laws>...};
}
template <class... Laws>
std::vector<Degrades> all_degrades(LawList<Laws...>) {
  return {&degrades_of<Laws>...};
}

}  // namespace

const std::vector<LawInfo>& catalogue() {
  static const std::vector<LawInfo> laws = describe_all(AllLaws{});
  return laws;
}

int find_law(std::string_view family, std::string_view name) {
  const std::vector<LawInfo>& laws = catalogue();
  for (std::size_t i = 0; i < laws.size(); ++i) {
    if (laws[i].family == family && laws[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

std::vector<std::string> law_names(std::string_view family) {
  std::vector<std::string> names;
  for (const LawInfo& law : catalogue()) {
    if (law.family == family) names.push_back(law.name);
  }
  return names;
}

std::vector<std::string> parameter_words(const ParameterInfo& info) {
  std::vector<std::string> words;
  if (info.words == nullptr) return words;
  std::string_view rest = info.words;
  while (!rest.empty()) {
    const std::size_t bar = rest.find('|');
    words.emplace_back(rest.substr(0, bar));
    rest = bar == std::string_view::npos ? std::string_view{} : rest.substr(bar + 1);
  }
  return words;
}

bool law_degrades(int law, const double* values, const MaterialConstants& constants) {
  static const std::vector<Degrades> degrades = all_degrades(AllLaws{});
  return degrades.at(static_cast<std::size_t>(law))(values, constants);
}

std::optional<double> thermal_energy_at_start(int law, const double* values,
                                              const MaterialConstants& constants) {
  static const std::vector<ThermalEnergy> energies = thermal_energies(AllLaws{});
  return energies.at(static_cast<std::size_t>(law))(values, constants);
}

const char* law_problem(int law, const double* values, const MaterialConstants& constants) {
  static const std::vector<Problem> problems = problems_of(AllLaws{});
  return problems.at(static_cast<std::size_t>(law))(values, constants);
}

}  // namespace krater
