// SPDX-License-Identifier: GPL-3.0-or-later
// Every card of inputs/materials reads, and the doctor doubts those it should.
#include "krater/app/card_doctor.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "unit/scene/scene_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

constexpr const char* kSpall = "no spall strength: nothing limits its tension";

/// The material of a card, read in a minimal scene; `more` overrides.
MaterialOptions read_card(const std::string& card, const std::string& more = "") {
  const ScratchFolder folder;
  const std::string scene =
      "frame: axisymmetric\n"
      "grid: {cell: 1 mm, box: {min: [0, 0], max: [10 mm, 20 mm]}, boundary: {r_min: axis}}\n"
      "time: {end: 1 us}\n"
      "materials:\n"
      "  it: {card: " +
      card + more +
      "}\n"
      "bodies:\n"
      "  rod: {material: it, shape: {cylinder: {radius: 3 mm, height: 12 mm}}}\n";
  return read_scene(folder.write("scene.yaml", scene)).materials.at(0);
}
std::string path_of(const std::string& name) {
  return std::filesystem::absolute(source_path("/inputs/materials/" + name + ".yaml")).string();
}

/// Doubts other than the missing spall strength.
std::vector<std::string> doubts_of(const MaterialOptions& material) {
  std::vector<std::string> doubts = examine(material);
  std::erase_if(doubts, [](const std::string& doubt) { return doubt.starts_with(kSpall); });
  return doubts;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("cards: every one reads, names its sources, and only the known ones are in doubt") {
    // How many doubts, of cards whose sources disagree with themselves.
    const std::map<std::string, std::size_t> known{
        {"ofhc_copper", 1}, {"silicon_carbide_jh2", 1}, {"ccf_steel_as_printed", 1},
        {"lead_mpm3d", 1},  {"copper_mpm3d", 1},        {"copper_karamelo", 1}};
    int cards = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator{source_path("/inputs/materials")}) {
      const std::string name = entry.path().stem().string();
      CAPTURE(name);
      const std::string text = slurp(entry.path().string());
      CHECK(text.find("# Sources:") != std::string::npos);
      const MaterialOptions material = read_card(path_of(name));
      const bool from_memory =
          text.find("from memory") != std::string::npos || text.find("verify") != std::string::npos;
      // What a card leaves unsourced may stand in its damage, which counts when asked for.
      const bool has_damage = text.find("\ndamage:") != std::string::npos;
      const auto whole = read_card(path_of(name), has_damage ? ", damage: card" : "");
      CHECK(from_memory == !whole.unsourced.empty());
      const auto doubts = doubts_of(material);
      if (!doubts.empty()) CAPTURE(doubts.front());
      const auto expected = known.find(name);
      CHECK(doubts.size() == (expected == known.end() ? 0 : expected->second));
      ++cards;
    }
    CHECK(cards >= 30);
  }

  TEST_CASE("doctor: our copper's K against rho0 c0^2, the CCF steel's specific heat") {
    const auto copper = doubts_of(read_card(path_of("ofhc_copper")));
    REQUIRE(copper.size() == 1);
    CHECK(copper[0] ==
          "the elastic constants give K = 129 GPa, the equation of state rho0 c0^2 = 139.1 GPa "
          "(+7.8 %); the equation of state is what runs");
    const auto steel = doubts_of(read_card(path_of("ccf_steel_as_printed")));
    REQUIRE(steel.size() == 1);
    CHECK(steel[0] ==
          "cp = 134 J/(kg K) at 7823 kg/m^3; expected iron or steel 449 (that is the value of "
          "tungsten alloy, tungsten)");
    CHECK(doubts_of(read_card(path_of("ccf_steel"))).empty());
  }

  TEST_CASE("doctor: traps of concrete and ceramic cards") {
    const auto first = [](const std::string& name, const std::string& more) {
      const auto doubts = doubts_of(read_card(path_of(name), more));
      return doubts.empty() ? std::string{} : doubts.front();
    };
    CHECK(
        first("silicon_carbide_jh2", "") ==
        "P_HEL and the elastic constants give HEL = 12.73 GPa, the card says 14.57 GPa (-12.6 %)");
    CHECK(first("alumina_995_jh2", ", model: {johnson_holmquist_2: {A: 0.5}}")
              .starts_with("the intact strength at P_HEL is 0.54"));
    const std::string published = ", model: {holmquist_johnson_cook: {unloading: published}}";
    for (const char* card : {"concrete_20", "concrete_44"})
      CHECK(first(card, published).starts_with("unloading: published is shallower (K1 = 17 GPa)"));
    CHECK(first("concrete_48", published).empty());
    CHECK(first("concrete_48", ", model: {holmquist_johnson_cook: {tensile_strength: 40 MPa}}")
              .starts_with("tensile_strength 40 MPa is 0.83"));
    const auto hjc = [&](const std::string& more) {
      return first("concrete_48", ", model: {holmquist_johnson_cook: {" + more + "}}");
    };
    CHECK(hjc("compressive_strength: 48").find("MPa meant? (4.8e+07 Pa)") != std::string::npos);
    CHECK(hjc("lock_compression: 10") ==
          "lock_compression = 10 is not of a solid, 0.001 to 1.5; percent meant? (0.1 1)");
    CHECK(hjc("crush_compression: 2e-6").starts_with("crush_compression = 2e-06 is not of"));
    CHECK(hjc("fracture_energy: 7e7").starts_with("fracture_energy = 7e+07 J/m^2 is not of"));
    const auto coarse =
        doubts_of(read_card("{concrete: {fc: 39 MPa, model: cscm, aggregate_size: 9.5}}"));
    REQUIRE(coarse.size() == 1);
    CHECK(coarse[0].starts_with(
        "aggregate_size = 9.5 m is not of a solid, 0.0001 to 0.15; mm meant?"));
  }

  TEST_CASE("doctor: a spall strength that the card offers is named") {
    const ScratchFolder folder;
    const std::string offers =
        folder.write("offers.yaml", slurp(path_of("steel_4340")) + "spall_strength: 3 GPa\n");
    const auto says = examine(read_card(offers));
    REQUIRE(says.size() == 1);
    CHECK(says[0] == std::string{kSpall} + "; its card has one (spall_strength: card)");
    CHECK(examine(read_card(offers, ", spall_strength: card")).empty());
  }

  TEST_CASE("doctor: a fracture strain that turns negative within reach, and those that do not") {
    const auto says = [](const std::string& name, const std::string& more) {
      std::string text;
      for (const std::string& doubt : doubts_of(read_card(path_of(name), more))) text += doubt;
      return text;
    };
    // 6061: D1 + D2 exp(1.5 D3) = -0.77 + 1.45 exp(-0.705) = -0.0535 before D5, at T* = 1
    // times 2.6.
    CHECK(says("al6061_t6", ", damage: card") ==
          "the fracture strain is -0.139 at triaxiality 1.5, T* = 1, 1e+00 /s: not positive; "
          "eps_f_min = 0.001 is what runs there");
    CHECK(says("al6061_t6", "").empty());
    CHECK(says("steel_4340", ", damage: card").empty());
    CHECK(says("ccf_steel", ", damage: card").empty());
    CHECK(says("weldox_460e", ", damage: card").empty());
    CHECK(says("weldox_700e", ", damage: card").empty());  // Cockcroft-Latham: no such strain
    const auto of = [&](const std::string& key) {
      return says("steel_4340", ", damage: {johnson_cook_uncoupled: {" + key + "}}");
    };
    CHECK(of("D4: -0.07").find("1e+07 /s") != std::string::npos);
    CHECK(of("D5: -1.2").find("T* = 1") != std::string::npos);
    CHECK(of("D3: 0.1").empty());
    CHECK(of("D4: -0.06").empty());
  }

  TEST_CASE("cards: every one with damage reads with it, and only the known are in doubt") {
    int cards = 0;
    std::string doubtful;
    for (const auto& entry :
         std::filesystem::directory_iterator{source_path("/inputs/materials")}) {
      const std::string name = entry.path().stem().string();
      CAPTURE(name);
      const MaterialOptions sound = read_card(path_of(name));
      CHECK_FALSE(sound.damage);
      if (std::count(sound.unused.begin(), sound.unused.end(), "damage") == 0) continue;
      const MaterialOptions damaged = read_card(path_of(name), ", damage: card");
      CHECK(damaged.damage);
      if (doubts_of(damaged).size() > doubts_of(sound).size()) doubtful += name + " ";
      ++cards;
    }
    CHECK(cards == 15);
    CHECK(doubtful.find("al6061_t6 ") != std::string::npos);
    CHECK(doubtful == "al6061_t6 ");
  }

  TEST_CASE("doctor: temperatures, melting point, Poisson's ratio, tension") {
    const std::string card = path_of("steel_4340");
    const auto says = [&](const std::string& more, const std::string& part) {
      CAPTURE(more);
      const auto doubts = doubts_of(read_card(card, more));
      REQUIRE(!doubts.empty());  // its magnitude may be doubted beside it
      CHECK(std::any_of(doubts.begin(), doubts.end(), [&](const std::string& doubt) {
        return doubt.find(part) != std::string::npos;
      }));
    };
    says(", initial_temperature: 2000 K", "starts molten");
    says(", initial_temperature: 600 K", "starts softened");
    says(", strength: {johnson_cook: {T_melt: 933 K}}", "T_melt = 933 K");
    says(", shear_modulus: 300 GPa", "Poisson's ratio of -0.");
    const auto all = examine(read_card(card));
    CHECK(std::count(all.begin(), all.end(), kSpall) == 1);
    CHECK(examine(read_card(card, ", spall_strength: 3 GPa")).empty());
    CHECK(examine(read_card(card, ", strength: none, heating: none")).empty());  // a fluid
    says(", strength: {johnson_cook: {T_ref: 20 K}}, initial_temperature: 60 K",
         "T_ref = 20 K looks like degrees Celsius");
    says(", initial_temperature: 20 K", "20 degC");
    CHECK(bulk_modulus_at_rest(read_card(card)) == doctest::Approx(7830.0 * 4570.0 * 4570.0));
  }
}
