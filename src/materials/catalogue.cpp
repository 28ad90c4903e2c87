// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/materials/catalogue.hpp"

#include "krater/materials/law_list.hpp"
#include "krater/materials/stages/burn_stage.hpp"

namespace krater {

namespace {

template <class Law>
LawInfo describe() {
  LawInfo info{.family = kFamilyNames[static_cast<int>(Law::family)],
               .name = Law::name,
               .parameters = {},
               .equation = Law::equation,
               .reference = Law::reference,
               .columns = {},
               .needs_shear_modulus = false,
               .whole_stress = false,
               .yields = Yielding<Law>,
               .dilates = Dilatant<Law>,
               .fails = Fails<Law>,
               .needs_flow = Law::family == Family::damage && needs_flow<Law>,
               .burns = Burns<Law>,
               .needs_eos = false};
  if constexpr (parameter_count < Law >> 0) {
    for (const Parameter<Law>& p : Law::parameters) info.parameters.push_back(p.info);
  }
  if constexpr (OwnsState<Law>)
    info.columns.assign(Law::State::infos.begin(), Law::State::infos.end());
  if constexpr (requires { Law::needs_shear_modulus; })
    info.needs_shear_modulus = Law::needs_shear_modulus;
  if constexpr (requires { Law::needs_eos; }) info.needs_eos = Law::needs_eos;
  if constexpr (requires { Law::whole_stress; }) info.whole_stress = Law::whole_stress;
  return info;
}

/// What a law says of parameters and constants; laws that say nothing have no function of the name.
struct LawAnswers {
  const char* problem = nullptr;
  bool degrades = false;
  std::optional<double> thermal_energy = {}, sound_speed = {}, shear_modulus = {}, length = {};
  std::optional<ProgrammedFront> front = {};
  std::vector<DerivedConstant> derived = {};
};

template <class Law>
LawAnswers ask(const double* values, const MaterialConstants& constants) {
  const Law law = make_law<Law>(values, constants);
  LawAnswers answers;
  if constexpr (requires { law.problem(); }) answers.problem = law.problem();
  if constexpr (requires { law.degrades(); }) answers.degrades = law.degrades();
  if constexpr (requires { law.thermal_energy(); }) answers.thermal_energy = law.thermal_energy();
  if constexpr (ShearOfState<Law>) answers.shear_modulus = law.G;
  if constexpr (requires { law.largest_length(); })
    if (law.largest_length() > 0) answers.length = law.largest_length();
  if constexpr (requires { law.derived(); })
    for (const auto& d : law.derived()) answers.derived.push_back({d.name, d.value, d.unit});
  if constexpr (Burns<Law>)
    if (law.lit()) answers.front = ProgrammedFront{law.D, law.front_width};
  if constexpr (Law::family == Family::eos || Law::family == Family::model)
    answers.sound_speed = law.c0;
  return answers;
}

using Ask = LawAnswers (*)(const double*, const MaterialConstants&);

template <class... Laws>
std::vector<LawInfo> describe_all(LawList<Laws...>) {
  return {describe<Laws>()...};
}
template <class... Laws>
std::vector<Ask> ask_all(LawList<Laws...>) {
  return {&ask<Laws>...};
}

LawAnswers answers_of(int law, const double* values, const MaterialConstants& constants) {
  static const std::vector<Ask> laws = ask_all(AllLaws{});
  return laws.at(static_cast<std::size_t>(law))(values, constants);
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
  return answers_of(law, values, constants).degrades;
}

std::optional<double> thermal_energy_at_start(int law, const double* values,
                                              const MaterialConstants& constants) {
  return answers_of(law, values, constants).thermal_energy;
}

std::optional<double> sound_speed_at_rest(int law, const double* values,
                                          const MaterialConstants& constants) {
  return answers_of(law, values, constants).sound_speed;
}

std::optional<double> own_shear_modulus(int law, const double* values,
                                        const MaterialConstants& constants) {
  return answers_of(law, values, constants).shear_modulus;
}

std::optional<double> largest_length(int law, const double* values,
                                     const MaterialConstants& constants) {
  return answers_of(law, values, constants).length;
}

std::vector<DerivedConstant> derived_constants(int law, const double* values,
                                               const MaterialConstants& constants) {
  return answers_of(law, values, constants).derived;
}

std::optional<ProgrammedFront> programmed_front(int law, const double* values,
                                                const MaterialConstants& constants) {
  return answers_of(law, values, constants).front;
}

const char* law_problem(int law, const double* values, const MaterialConstants& constants) {
  return answers_of(law, values, constants).problem;
}

}  // namespace krater
