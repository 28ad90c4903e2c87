// SPDX-License-Identifier: GPL-3.0-or-later
// What a card holds and a scene must ask for: damage, spall_strength. And heating by energy.
#include <doctest/doctest.h>

#include "scene_support.hpp"

using namespace krater;
using namespace krater::test;

namespace {

constexpr const char* kCard =
    "density: 7800\nspall_strength: 2 GPa\n"
    "damage: {lemaitre_energy: {S: 1 MPa, phi_c: 0.4}, coupling: rate}\n";

/// A scene whose steel has the card and the block; returns its file.
std::string scene_with(const ScratchFolder& folder, const std::string& block,
                       const std::string& card = kCard) {
  folder.write("mild.yaml", card);
  return folder.write("scene.yaml",
                      replaced(small_scene(), "    viscosity: {q_lin: 0.3}\n",
                               "    viscosity: {q_lin: 0.3}\n    card: ./mild.yaml\n" + block));
}

MaterialOptions steel(const ScratchFolder& folder, const std::string& block,
                      const std::string& card = kCard) {
  return read_scene(scene_with(folder, block, card)).materials.at(0);
}

void refuses(const std::string& file, const std::vector<const char*>& parts) {
  const std::string message = message_of(file);
  CAPTURE(message);
  for (const char* part : parts) CHECK_MESSAGE(message.find(part) != std::string::npos, part);
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("card effects: not asked for, not there; the scene knows what it leaves unused") {
    const ScratchFolder folder;
    const MaterialOptions m = steel(folder, "");
    CHECK_FALSE(m.damage);
    CHECK_FALSE(m.spall_strength);
    CHECK(m.unused == std::vector<std::string>{"damage", "spall_strength"});
    const MaterialOptions none = steel(folder, "    damage: none\n");
    CHECK_FALSE(none.damage);
    CHECK(none.unused == std::vector<std::string>{"spall_strength"});
  }

  TEST_CASE("card effects: `card` takes the card's; own numbers lie over them") {
    const ScratchFolder folder;
    const MaterialOptions m = steel(folder, "    damage: card\n    spall_strength: card\n");
    REQUIRE(m.damage);
    CHECK(m.damage->name == "lemaitre_energy");
    CHECK(m.damage->values.at(0) == 1e6);
    CHECK(m.coupling == Coupling::rate);
    CHECK(m.spall_strength == 2e9);
    CHECK(m.unused.empty());
    const MaterialOptions over =
        steel(folder, "    damage: {lemaitre_energy: {S: 3 MPa}}\n    spall_strength: 1 GPa\n");
    CHECK(over.damage->values.at(0) == 3e6);
    CHECK(over.damage->values.at(3) == 0.4);
    CHECK(over.coupling == Coupling::rate);
    CHECK(over.spall_strength == 1e9);
    // From --set, and the resolved scene reads back without the card.
    const std::string file = scene_with(folder, "");
    const Scene set = read_scene(file, {"materials.steel.damage=card"});
    REQUIRE(set.materials.at(0).damage);
    const Scene again = read_scene(folder.write("resolved.yaml", set.resolved));
    CHECK(again.materials.at(0).damage->values == set.materials.at(0).damage->values);
  }

  TEST_CASE("card effects: asked for where there is none: what, where, and which cards have it") {
    const ScratchFolder folder;
    folder.write("materials/ductile.yaml", kCard);
    refuses(scene_with(folder, "    damage: card\n", "density: 7800\n"),
            {"scene.yaml:", "materials.steel.damage: the card './mild.yaml' has no damage",
             "cards that have it: ", "ductile"});
    refuses(folder.write("bare.yaml", replaced(small_scene(), "    viscosity: {q_lin: 0.3}\n",
                                               "    spall_strength: card\n")),
            {"materials.steel.spall_strength: 'card' takes it from the material's card, and there "
             "is none"});
  }

  TEST_CASE("heating by energy: one or the other, an eos, and a start that fits a gas") {
    const ScratchFolder folder;
    const auto with = [&](const std::string& from, const std::string& to) {
      return folder.write("heat.yaml", replaced(small_scene(), from, to));
    };
    const std::string viscosity = "    viscosity: {q_lin: 0.3}\n";
    const Scene good = read_scene(with(viscosity, "    heating: {energy: {c_v: 477 J/(kg K)}}\n"));
    CHECK(good.materials.at(0).heating->name == "energy");
    CHECK(good.materials.at(0).heating->values.at(0) == 477.0);
    refuses(with(viscosity, "    heating: {energy: {c_v: 477}, plastic_work: {cp: 477}}\n"),
            {"materials.steel.heating", "only one model"});
    refuses(with(viscosity, "    heating: {energy: {}}\n"), {"missing key 'c_v'"});
    const std::string gas =
        "frame: axisymmetric\n"
        "grid: {cell: 1 mm, box: {min: [0, 0], max: [10 mm, 20 mm]}, boundary: {r_min: axis}}\n"
        "time: {end: 1 us}\n"
        "materials:\n"
        "  air: {density: 1.2, initial_temperature: 293, heating: {energy: {c_v: CV}},\n"
        "        eos: {ideal_gas: {gamma: 1.4, initial_pressure: 1e5}}}\n"
        "bodies:\n"
        "  rod: {material: air, shape: {cylinder: {radius: 3 mm, height: 12 mm}}}\n";
    CHECK(message_of(folder.write("air.yaml", replaced(gas, "CV", "711"))).empty());
    refuses(
        folder.write("air.yaml", replaced(gas, "CV", "1000")),
        {"eos ideal_gas starts with 2.0833e+05 J/kg of heat", "208.33 K", "c_v: 711.04 J/(kg K)"});
    const std::string solid = replaced(gas, "eos: {ideal_gas: {gamma: 1.4, initial_pressure: 1e5}}",
                                       "shear_modulus: 1e9, strength: {neo_hookean: {lame_lambda: "
                                       "1e9}}");
    refuses(folder.write("neo.yaml", replaced(solid, "CV", "711")),
            {"takes the temperature from an eos"});
  }
}
