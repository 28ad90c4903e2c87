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
    {"damage: {tuler_butcher: {stress: 50 MPa, time: 1 us}, coupling: rate}",
     "materials.steel",
     {"tuler_butcher does not grow with plastic strain"}},
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
    const std::string brittle = replaced(elastic, "maximum_plastic_strain: {eps_max: 0.3}",
                                         "tuler_butcher: {stress: 50 MPa, time: 1 us}");
    CHECK(read_scene(folder.write("brittle.yaml", brittle)).materials.at(0).damage);
    const std::string alone = replaced(brittle, "    strength:\n      elastic\n", "");
    CHECK(message_of(folder.write("alone.yaml", alone)).find("tuler_butcher needs a strength") !=
          std::string::npos);
    std::string fluid =
        replaced(small_scene(), "    strength:\n      von_mises: {Y: 400 MPa, H: 100 MPa}\n",
                 "    rate: jaumann\n");
    CHECK(message_of(folder.write("fluid.yaml", fluid)).find("rate needs a strength") !=
          std::string::npos);
  }

  TEST_CASE("a model stands alone: what it gives is refused beside it, by name") {
    const ScratchFolder folder;
    const std::string concrete =
        "model: {holmquist_johnson_cook: {compressive_strength: 48 MPa, A: 0.79, B: 1.6, N: 0.61, "
        "S_max: 7, D1: 0.04, tensile_strength: 4 MPa, crush_pressure: 16 MPa, crush_compression: "
        "0.001, lock_pressure: 0.8 GPa, lock_compression: 0.1, K1: 85 GPa}}";
    const std::string beside = with(concrete + "\n    spall_strength: 1 GPa");
    const std::string message = message_of(folder.write("beside.yaml", beside));
    CAPTURE(message);
    CHECK(message.find("materials.steel: model holmquist_johnson_cook gives strength, pressure and "
                       "damage: remove strength, eos, spall") != std::string::npos);
    const std::string more = "\n    failure: {action: remove}\n    rate: jaumann";
    std::string own = replaced(with(concrete + more),
                               "    strength:\n      von_mises: {Y: 400 MPa, H: 100 MPa}\n", "");
    own = replaced(own, "    eos: {linear: {bulk_modulus: 160 GPa}}\n", "");
    const Scene scene = read_scene(folder.write("model.yaml", own));
    const MaterialOptions& m = scene.materials.at(0);
    REQUIRE(m.model);
    CHECK(value_of(*m.model, "lock_strain") == 0);
    CHECK(m.failure == FailureAction::remove);
    const Scene again = read_scene(folder.write("resolved.yaml", scene.resolved));
    CHECK(again.materials.at(0).model->values == m.model->values);
    const std::string soft = replaced(own, "crush_compression: 0.001", "crush_compression: 0.5");
    CHECK(message_of(folder.write("soft.yaml", soft)).find("lock_compression must lie above") !=
          std::string::npos);
    const std::string hot = replaced(own, "    rate: jaumann", "    heating: {energy: {c_v: 800}}");
    CHECK(message_of(folder.write("hot.yaml", hot)).find("takes the temperature from an eos") !=
          std::string::npos);
    const std::string wrong = replaced(own, "holmquist_johnson_cook", "hjc");
    CHECK(message_of(folder.write("wrong.yaml", wrong)).find("unknown model 'hjc'") !=
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
