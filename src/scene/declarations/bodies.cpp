// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies: points, motion, kinematics.
#include "scene/declarations/declarations.hpp"

namespace krater::scene {

using namespace forms;

namespace {

constexpr int kMostPerDirection = 8;

KeyInfo per_direction(const char* fallback) {
  return {"per_direction",
          "points of a cell along each axis: one number, or one per axis",
          {integer(1, kMostPerDirection), list({integer(1, kMostPerDirection)}, 2, 3)},
          fallback};
}

KeyInfo velocity(const char* meaning) {
  return {"velocity", meaning, {list({number("m/s"), text()}, 2, 3), block(speed_block)}, ""};
}

KeyInfo turn() { return {"turn", "rotation added to the velocity", {block(turn_block)}, ""}; }

}  // namespace

const BlockInfo& body_block() {
  static const BlockInfo info{
      "body",
      "A body: what it is made of, its shape and how it moves at the start.",
      {{"material", "one of the scene's materials", {text()}, kMust},
       {"shape", "what it fills", {block(shape_block)}, kMust},
       velocity("at the start: components (numbers, or expressions in x y z r t), or a speed"),
       turn(),
       {"rigid",
        "free: moved by what it meets; a block: moves as prescribed at all times",
        {word({"none", "free"}), block(rigid_block)},
        ""},
       {"kinematics",
        "material points, a mesh of elements, or particles",
        {word({"mpm", "lagrangian_mesh", "sph"}), block(kinematics_block)},
        "mpm"},
       {"thin",
        "may the body be no more than a cell thick?",
        {word({"refused", "allowed"})},
        "refused"},
       {"points", "how it is filled", {block(points_block)}, ""},
       {"wins_over",
        "bodies from which this one is cut out where they overlap",
        {list({text()})},
        ""}}};
  return info;
}

const BlockInfo& points_block() {
  static const BlockInfo info{
      "points",
      "How a body is filled with points.",
      {per_direction("(method.points_per_direction)"),
       {"lattice",
        "along the grid's cells, or along the body's own axes",
        {word({"grid", "body"})},
        "grid"},
       {"jitter",
        "greatest random shift of a point, in point spacings",
        {number("1", Range::fraction)},
        "(method.jitter)"},
       {"seed", "of random shifts", {integer(0, 1'000'000'000)}, "(method.seed)"},
       {"zones", "boxes with more points", {list({block(zone_block)})}, ""}}};
  return info;
}

const BlockInfo& zone_block() {
  static const BlockInfo info{
      "points.zones",
      "A box in which cells have more points.",
      {{"min", "lower corner", {vector("m")}, kMust},
       {"max", "upper corner", {vector("m")}, kMust},
       per_direction("4"),
       {"falloff", "cells over which the number falls to that outside", {integer(1, 1000)}, "2"}}};
  return info;
}

const BlockInfo& speed_block() {
  static const BlockInfo info{
      "speed",
      "A velocity by its size and direction: towards or angle.",
      {{"speed", "size of the velocity", {number("m/s", Range::non_negative)}, kMust},
       {"towards", "direction: a vector of any length, or x, -x, z, -z", {text(), vector("1")}, ""},
       {"angle", "obliquity: from -z, straight down, towards +x", {number("rad")}, kWhereUsed}}};
  return info;
}

const BlockInfo& turn_block() {
  static const BlockInfo info{
      "turn",
      "A rotation, omega x (x - c).",
      {{"axis",
        "x, y, z, -x, -y, -z or a vector; plane strain turns about y",
        {text(), vector("1")},
        "(y in plane strain)"},
       {"rate", "angular velocity, right-handed about the axis", {number("radian/s")}, kMust},
       {"through", "c, a point of the axis", {vector("m")}, "(the body's centroid)"}}};
  return info;
}

const BlockInfo& rigid_block() {
  static const BlockInfo info{"rigid",
                              "The motion of a rigid body at all times.",
                              {velocity("numbers, or expressions in t"), turn()}};
  return info;
}

const BlockInfo& kinematics_block() {
  static const BlockInfo info{
      "kinematics",
      "What a body is made of, with its options.",
      {{"lagrangian_mesh",
        "elements that go with the material",
        {block(lagrangian_mesh_block)},
        ""},
       {"sph", "smoothed particles (3d and plane strain)", {block(sph_block)}, ""}},
      true};
  return info;
}

const BlockInfo& lagrangian_mesh_block() {
  static const BlockInfo info{
      "lagrangian_mesh",
      "A mesh of one-point quadrilaterals or hexahedra.",
      {{"element", "edge of an element", {number("m", Range::positive)}, "(grid.cell)"},
       {"hourglass",
        "what holds the motions that one point does not see",
        {word({"assumed_strain", "stiffness", "viscous"}), block(hourglass_block)},
        "assumed_strain"},
       {"reference",
        "mesh on which gradients are taken",
        {word({"current", "initial", "adaptive"}), block(body_reference_block)},
        "current"},
       {"failure", "elements that are taken out", {block(element_failure_block)}, ""}}};
  return info;
}

const BlockInfo& hourglass_block() {
  static const BlockInfo info{
      "hourglass",
      "A coefficient; one of the two.",
      {{"viscous", "coefficient of the viscous hourglass", {number("1", Range::positive)}, ""},
       {"stiffness",
        "coefficient of the stiffness of the hourglass",
        {number("1", Range::positive)},
        ""}}};
  return info;
}

const BlockInfo& element_failure_block() {
  static const BlockInfo info{
      "lagrangian_mesh.failure",
      "When elements are taken out, and what becomes of them.",
      {{"action", "they vanish, or become material points", {word({"erode", "convert"})}, "erode"},
       {"when", "limits; one that is reached is enough", {block(element_limits_block)}, kMust}}};
  return info;
}

const BlockInfo& element_limits_block() {
  static const auto limit = [](const char* key, const char* unit, const char* meaning) {
    return KeyInfo{key, meaning, {number(unit, Range::positive)}, ""};
  };
  static const BlockInfo info{
      "lagrangian_mesh.failure.when",
      "Limits of an element.",
      {{"failed", "by damage or spall", {flag()}, "false"},
       limit("plastic_strain", "1", "at which an element is taken out"),
       limit("step", "s", "stable step below which an element is taken out"),
       limit("jacobian", "1", "least of the corners by their mean"),
       limit("least_volume", "1", "ratio to the start below which it is taken out"),
       limit("greatest_volume", "1", "ratio to the start above which it is taken out")}};
  return info;
}

const BlockInfo& body_reference_block() {
  static const auto adaptive = []() -> const BlockInfo& {
    static const BlockInfo options{"kinematics.reference.adaptive",
                                   "When the reference is renewed.",
                                   {{"strain",
                                     "greatest Green-Lagrange strain on one reference",
                                     {number("1", Range::positive)},
                                     "0.3"}}};
    return options;
  };
  static const BlockInfo info{
      "kinematics.reference",
      "A reference that is renewed.",
      {{"adaptive", "that of the start, renewed when strained", {block(adaptive)}, kMust}}};
  return info;
}

const BlockInfo& sph_block() {
  static const BlockInfo info{
      "sph",
      "Smoothed particles.",
      {{"spacing",
        "of the particles at the start, along each axis",
        {number("m", Range::positive)},
        "(grid.cell / method.points_per_direction)"},
       {"smoothing",
        "smoothing length h over the spacing, 1 to 2",
        {number("1", Range::positive)},
        "1.2"},
       {"zero_energy",
        "viscosity of pairs that holds modes the gradients do not see; 0: none",
        {number("1", Range::fraction)},
        "1"},
       {"artificial_stress",
        "share of tension taken back between close particles; 0: none, 0.3: of the source",
        {number("1", Range::fraction)},
        "0"},
       {"kernel",
        "weight of neighbours",
        {word({"cubic_spline", "wendland_c2", "quadratic"})},
        "quadratic"},
       {"correction",
        "of gradients: exact for linear fields, or none",
        {word({"linear", "none"})},
        "linear"},
       {"reference",
        "where neighbours and weights are taken",
        {word({"current", "initial", "adaptive"}), block(body_reference_block)},
        "current"}}};
  return info;
}

}  // namespace krater::scene
