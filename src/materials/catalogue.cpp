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
               .whole_stress = false};
  if constexpr (parameter_count < Law >> 0) {
    for (const Parameter<Law>& p : Law::parameters) info.parameters.push_back(p.info);
  }
  if constexpr (requires { Law::needs_shear_modulus; }) {
    info.needs_shear_modulus = Law::needs_shear_modulus;
  }
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

using Problem = const char* (*)(const double*, const MaterialConstants&);

template <class... Laws>
std::vector<LawInfo> describe_all(LawList<Laws...>) {
  return {describe<Laws>()...};
}
template <class... Laws>
std::vector<Problem> problems_of(LawList<Laws...>) {
  return {&problem_of<Laws>...};
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

const char* law_problem(int law, const double* values, const MaterialConstants& constants) {
  static const std::vector<Problem> problems = problems_of(AllLaws{});
  return problems.at(static_cast<std::size_t>(law))(values, constants);
}

}  // namespace krater
