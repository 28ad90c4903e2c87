// SPDX-License-Identifier: GPL-3.0-or-later
// Damage, failure, spall strength and rate of a material: what is read, and what is said about
// mistakes.
#include <doctest/doctest.h>

#include "krater/materials/catalogue.hpp"
#include "scene_support.hpp"

using namespace krater;
using namespace krater::test;

namespace {

struct Mistake {
  std::string block;  ///< added to the material of the small scene
  const char* path;   ///< where the message points
  std::vector<const char*> parts;
};

const std::vector<Mistake> kMistakes = {
    {"damage: {lemaitre: {S: 1 MPa}}",
     "materials.steel.damage",
     {"unknown model 'lemaitre'", "lemaitre_energy", "johnson_cook_uncoupled"}},
    {"damage: {lemaitre_energy: {s: 1}}",
     "materials.steel.damage.lemaitre_energy",
     {"missing key 'S'", "in Pa"}},
    {"damage: {lemaitre_energy: {S: 1 MPa, phi_c: 1}}",
     "materials.steel.damage.lemaitre_energy",
     {"phi_c may be 0.999 at most"}},
    {"damage: {lemaitre_energy: {S: 1 MPa, phi_c: 1.5}}",
     "materials.steel.damage.lemaitre_energy.phi_c",
     {"'1.5'"}},
    {"damage: {johnson_cook: {D1: 0.1, D2: 1, D3: -1, normalise: critcal}}",
     "materials.steel.damage.johnson_cook.normalise",
     {"unknown value 'critcal'", "printed", "critical"}},
    {"damage: {johnson_cook: {D1: 0.1, D2: 1, D3: -1, D5: 1}}",
     "materials.steel.damage.johnson_cook",
     {"D5 needs T_melt above T_ref"}},
    {"damage: {maximum_plastic_strain: {eps_max: 0.3}, coupling: effectiv}",
     "materials.steel.damage.coupling",
     {"unknown value 'effectiv'", "effective, rate"}},
    {"damage: {maximum_plastic_strain: {eps_max: 0.3}, degrade: none}",
     "materials.steel.damage.degrade",
     {"only one model"}},
    {"damage: {maximum_plastic_strain: {eps_max: 0.3}, coupling: rate}",
     "materials.steel",
     {"maximum_plastic_strain does not degrade the stress"}},
    {"damage: {coupling: rate}", "materials.steel.damage", {"expected one model"}},
    {"damage: {maximum_plastic_strain: {eps_max: 0.3}}\n    failure: {action: erode}",
     "materials.steel.failure.action",
     {"unknown value 'erode'", "strength_loss", "remove"}},
    {"failure: {action: strength_loss}", "materials.steel.failure", {"needs damage"}},
    {"spall_strength: -1 GPa", "materials.steel.spall_strength", {"must be positive"}},
    {"spall_strength: 1 mm", "materials.steel.spall_strength", {"wrong dimension"}},
    {"rate: jauman", "materials.steel.rate", {"unknown value 'jauman'", "jaumann"}},
};

std::string with(const std::string& block) {
  return replaced(small_scene(), "    viscosity: {q_lin: 0.3}\n",
                  "    viscosity: {q_lin: 0.3}\n    " + block + "\n");
}

double value_of(const LawChoice& choice, const std::string& key) {
  const LawInfo& law = catalogue().at(static_cast<std::size_t>(choice.law));
  for (std::size_t i = 0; i < law.parameters.size(); ++i)
    if (key == law.parameters[i].key) return choice.values.at(i);
  FAIL("no parameter ", key);
  return 0;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("damage scenes: every mistake is named with its place, reason and remedy") {
    const ScratchFolder folder;
    for (const Mistake& mistake : kMistakes) {
      CAPTURE(mistake.block);
      const std::string message = message_of(folder.write("bad.yaml", with(mistake.block)));
      CAPTURE(message);
      CHECK(message.find(std::string{": "} + mistake.path + ": ") != std::string::npos);
      for (const char* part : mistake.parts)
        CHECK_MESSAGE(message.find(part) != std::string::npos, part);
    }
    std::string elastic = with("damage: {maximum_plastic_strain: {eps_max: 0.3}}");
    elastic = replaced(elastic, "von_mises: {Y: 400 MPa, H: 100 MPa}", "elastic");
    CHECK(message_of(folder.write("elastic.yaml", elastic)).find("needs a strength that yields") !=
          std::string::npos);
    std::string fluid =
        replaced(small_scene(), "    strength:\n      von_mises: {Y: 400 MPa, H: 100 MPa}\n",
                 "    rate: jaumann\n");
    CHECK(message_of(folder.write("fluid.yaml", fluid)).find("rate needs a strength") !=
          std::string::npos);
  }

  TEST_CASE("damage scenes: what is asked for arrives; resolved.yaml reads back the same") {
    const ScratchFolder folder;
    const std::string file = folder.write(
        "good.yaml", with("damage: {johnson_cook: {D1: 0.1, D2: 1, D3: -1, normalise: critical}, "
                          "coupling: rate, degrade_pressure: all}\n"
                          "    failure: {action: strength_loss}\n"
                          "    spall_strength: 2 GPa\n    rate: green_naghdi"));
    const Scene scene = read_scene(file);
    const Scene again = read_scene(folder.write("resolved.yaml", scene.resolved));
    const auto body = [](const Scene& s) { return s.resolved.substr(s.resolved.find('\n')); };
    CHECK(body(again) == body(scene));  // the first line names the file
    for (const Scene* s : {&scene, &again}) {
      const MaterialOptions& m = s->materials.at(0);
      REQUIRE(m.damage);
      CHECK(value_of(*m.damage, "D2") == 1);
      CHECK(value_of(*m.damage, "normalise") == 1);
      CHECK(value_of(*m.damage, "phi_c") == 0.999);
      CHECK(m.coupling == Coupling::rate);
      CHECK(m.degrade_pressure == DegradePressure::all);
      CHECK(m.rate == Rate::green_naghdi);
      CHECK(m.spall_strength == 2e9);
    }
    const Scene plain = read_scene(folder.write("plain.yaml", small_scene()));
    CHECK_FALSE(plain.materials[0].damage);
    CHECK_FALSE(plain.materials[0].spall_strength);
    CHECK(plain.materials[0].rate == Rate::truesdell);
    const Scene none = read_scene(folder.write("none.yaml", with("damage: none")));
    CHECK_FALSE(none.materials[0].damage);
  }
}
