// SPDX-License-Identifier: GPL-3.0-or-later
// Loading paths of one material point.
#include "scene/declarations/declarations.hpp"

namespace krater::scene {

using namespace forms;

namespace {

/// `0.5`, `[0.5, 0, 0.7]` or `{from: a, to: b, count: n}`.
KeyInfo values(const char* key, const char* unit, const char* meaning,
               const char* fallback = kMust) {
  return {key, meaning, {number(unit), list({number(unit)}, 1), block(even_block)}, fallback};
}
KeyInfo rate() {
  return {"rate", "rate of the strain or shear", {number("s^-1", Range::positive)}, kMust};
}
KeyInfo lateral() {
  return {"lateral_stress", "stress on the sides, tension positive", {number("Pa")}, kWhereUsed};
}
KeyInfo end() { return {"time", "end of the path", {number("s", Range::positive)}, kMust}; }
KeyInfo tensor(const char* key, const char* unit, const char* meaning) {
  const std::vector<Form> component{number(unit), text()};
  return {key, meaning, {list({number(unit), text(), list(component, 3, 3)}, 3, 3)}, kMust};
}
KeyInfo speeds() {
  return values("particle_speed", "m/s", "behind the shock; this or density", "");
}
KeyInfo densities() {
  return values("density", "kg/m^3", "behind the shock; this or particle_speed", "");
}

std::vector<BlockInfo> paths() {
  constexpr const char* kTurns = "a number, or a list of where the path turns";
  return {
      {"uniaxial_stress",
       "Stretched along x, sides free.",
       {values("strain", "1", kTurns), rate()}},
      {"uniaxial_strain",
       "Stretched along x, sides held.",
       {values("strain", "1", kTurns), rate()}},
      {"simple_shear", "Sheared in the plane x, y.", {values("shear", "1", kTurns), rate()}},
      {"triaxial",
       "Stretched along x; one of lateral_stress and triaxiality.",
       {values("strain", "1", kTurns),
        rate(),
        lateral(),
        {"triaxiality", "mean stress over von Mises stress", {number("1")}, kWhereUsed}}},
      {"hydrostatic",
       "Compressed on all sides; one of compression and pressure.",
       {values("compression", "1", "rho/rho0 - 1", ""),
        values("pressure", "Pa", "the pressure", ""), rate()}},
      {"biaxial", "Stretched along x and y.", {values("strain", "1", kTurns), rate(), lateral()}},
      {"stretch",
       "A deformation gradient over time, the identity at the start.",
       {tensor("F", "1", "three rows of three components, or the diagonal, in t"), end()}},
      {"velocity_gradient",
       "A velocity gradient over time.",
       {tensor("L", "s^-1", "three rows of three components, or the diagonal, in t"), end()}},
      {"hugoniot", "States behind shocks.", {speeds(), densities()}},
      {"release_isentrope",
       "Release from a shocked state.",
       {speeds(),
        densities(),
        {"pressure", "at the end of the release", {number("Pa")}, "0"},
        {"rate",
         "nominal rate of the volume strain",
         {number("s^-1", Range::positive)},
         "1000000"}}}};
}

}  // namespace

const BlockInfo& point_block() {
  static const BlockInfo info{"point",
                              "A material point and its path.",
                              {{"material", "one of the materials", {text()}, "(the only one)"},
                               {"path", "how the material is loaded", {block(path_block)}, kMust},
                               {"steps", "of the path", {integer(1, 100'000'000)}, "1000"},
                               {"every", "steps between rows", {integer(1, 100'000'000)}, "1"},
                               {"temperature",
                                "at the start of the path",
                                {number("K", Range::positive)},
                                "(initial_temperature)"},
                               {"length",
                                "element length, which viscosity and softening by an energy need",
                                {number("m", Range::positive)},
                                kWhereUsed}}};
  return info;
}

const BlockInfo& path_block() {
  static const std::vector<BlockInfo> made = paths();
  static const BlockInfo info = [] {
    BlockInfo choice{"path", "One loading path.", {}};
    choice.one_of = true;
    for (const BlockInfo& path : made) {
      const BlockInfo* at = &path;
      choice.keys.push_back(
          {path.name, path.meaning, {block([at]() -> const BlockInfo& { return *at; })}, ""});
    }
    return choice;
  }();
  return info;
}

const BlockInfo& even_block() {
  static const BlockInfo info{"values",
                              "Values in equal steps.",
                              {{"from", "first value", {number("")}, kMust},
                               {"to", "last value", {number("")}, kMust},
                               {"count", "how many", {integer(2, 1'000'000)}, "21"}}};
  return info;
}

}  // namespace krater::scene
