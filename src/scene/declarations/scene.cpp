// SPDX-License-Identifier: GPL-3.0-or-later
// The file as a whole; time, method, output, contact.
#include <memory>
#include <utility>

#include "scene/declarations/declarations.hpp"

namespace krater::scene {

using namespace forms;

namespace {

/// A block of named members.
BlockMaker named(const char* name, const char* meaning, BlockMaker member) {
  const auto info = std::make_shared<const BlockInfo>(
      BlockInfo{name, meaning, {{"*", "a name of your own", {block(std::move(member))}, ""}}});
  return [info]() -> const BlockInfo& { return *info; };
}

KeyInfo title() { return {"title", "for pictures and tables", {text()}, "(the file's name)"}; }

KeyInfo materials() {
  return {"materials",
          "the materials by name",
          {block(named("materials", "Materials, each under a name of its own.", material_block))},
          kMust};
}

}  // namespace

const BlockInfo& nothing_block() {
  static const BlockInfo info{"nothing", "Takes no keys.", {}};
  return info;
}

const BlockInfo& scene_block() {
  static const BlockInfo info{
      "scene",
      "What krater run computes. Lengths and other values carry units (25.4 mm, 190 m/s, 90 MPa); "
      "a bare number is SI.",
      {title(),
       {"frame",
        "what the two or three coordinates are",
        {word({"axisymmetric", "plane_strain", "3d"})},
        kMust},
       {"grid", "the background grid and the sides of the domain", {block(grid_block)}, kMust},
       {"time", "when the run ends and how it steps", {block(time_block)}, kMust},
       {"method", "the scheme; its defaults are measured ones", {block(method_block)}, ""},
       materials(),
       {"bodies",
        "the bodies by name",
        {block(named("bodies", "Bodies, each under a name of its own.", body_block))},
        kMust},
       {"contact",
        "how bodies meet; without it they share one velocity field and stick",
        {word({"none"}), block(contact_block)},
        ""},
       {"body_force",
        "acceleration of everything: numbers or expressions in x y z r t",
        {list({number("m/s^2"), text()}, 2, 3)},
        ""},
       {"damping", "of all deformable bodies", {word({"none"}), block(damping_block)}, ""},
       {"loads",
        "pressure, traction or velocity on faces of bodies",
        {word({"none"}), block(loads_block)},
        ""},
       {"detonators",
        "where fronts start in explosives (eos: jwl_burn)",
        {word({"none"}), block(named("detonators", "Detonators by name.", detonator_block))},
        ""},
       {"output", "what is written, and how often", {block(output_block)}, ""},
       {"measures",
        "numbers to follow: a column of the history and an entry of summary.json each",
        {block(named("measures", "Measures by name.", measure_block))},
        ""},
       {"outcomes",
        "what became of projectiles",
        {word({"none"}), block(named("outcomes", "Outcomes by name.", outcome_block))},
        ""},
       {"gauges",
        "records at times of their own",
        {word({"none"}), block(named("gauges", "Gauges by name.", gauge_block))},
        ""},
       {"references",
        "what measures should be, by the name of the measure",
        {block(references_block)},
        ""},
       {"expect",
        "what must hold of the results; tools/hard judges, krater keeps it",
        {any()},
        ""}}};
  return info;
}

const BlockInfo& point_scene_block() {
  static const BlockInfo info{
      "loading path",
      "What krater point computes: one material on a loading path.",
      {title(), materials(), {"point", "the path", {block(point_block)}, kMust}}};
  return info;
}

const BlockInfo& time_block() {
  static const BlockInfo info{
      "time",
      "When the run ends and how it steps.",
      {{"end", "time at which the run ends", {number("s", Range::positive)}, kMust},
       {"cfl", "share of the limit of stability, at most 1", {number("1", Range::positive)}, "0.9"},
       {"max_step", "longest time step, 0: any", {number("s", Range::non_negative)}, "0"},
       {"min_step",
        "a shorter time step is a failure, 0: 1e-6 of the first",
        {number("s", Range::non_negative)},
        "0"},
       {"first_step", "0: automatic", {number("s", Range::non_negative)}, "0"},
       {"energy_error",
        "greatest share of the energy that may be unphysical before the run fails, or off",
        {number("1", Range::positive), word({"off"})},
        "0.1"},
       {"stop_when",
        "ends the run before `end`: a condition, or an expression of columns of the "
        "history such as rod.mean_velocity_z > -100",
        {text(), block(stop_block)},
        ""}}};
  return info;
}

const BlockInfo& stop_block() {
  static const BlockInfo info{
      "stop_when",
      "A condition on which the run ends.",
      {{"settled",
        "a body: its velocity no longer changes, and its outcome is there",
        {text()},
        ""},
       {"perforated", "a projectile is through its target", {block(perforated_block)}, ""},
       {"energy",
        "the kinetic energy has fallen to this share of that at the start",
        {number("1", Range::fraction)},
        ""}},
      true};
  return info;
}

const BlockInfo& perforated_block() {
  static const BlockInfo info{"perforated",
                              "Who goes through whom.",
                              {{"projectile", "a body", {text()}, kMust},
                               {"target", "the body that it goes through", {text()}, kMust}}};
  return info;
}

const BlockInfo& method_block() {
  static const BlockInfo info{
      "method",
      "The scheme of bodies of material points.",
      {{"shape",
        "shape functions of the grid",
        {word({"quadratic_bspline", "gimp", "linear"})},
        "quadratic_bspline"},
       {"transfer",
        "what goes from points to nodes and back",
        {word({"tflip", "flip", "apic", "xpic"}), block(transfer_block)},
        "tflip"},
       {"reference",
        "configuration on which gradients are taken",
        {word({"current", "initial", "adaptive"}), block(method_reference_block)},
        "current"},
       {"update",
        "when stresses are updated: last, twice, first",
        {word({"usl", "musl", "usf"})},
        "usl"},
       {"points_per_direction",
        "points of a cell along each axis at the start",
        {integer(1, 8)},
        "2"},
       {"stagger",
        "columns of points shifted against each other, so that none lie in line",
        {flag()},
        "true"},
       {"jitter",
        "greatest random shift of a point, in point spacings",
        {number("1", Range::fraction)},
        "0"},
       {"seed", "of random shifts", {integer(0, 1'000'000'000)}, "1"},
       {"cell_averaging",
        "pressure and density of a point are those of its cell",
        {flag()},
        "true"},
       {"grid_pressure",
        "bodies whose pressure is computed on the grid: those without strength, "
        "none, all",
        {word({"fluids", "none", "all"})},
        "fluids"},
       {"flip_fraction",
        "part of the residual of a point's own velocity kept in a step (tflip)",
        {number("1", Range::fraction)},
        "0.99"},
       {"energy_alpha",
        "alpha of Algorithm 1: share of the pressure of the start in the energy "
        "that gives the new one",
        {number("1", Range::fraction)},
        "0.5"},
       {"dormant_blocks", "blocks in which nothing moves are passed over", {flag()}, "true"},
       {"numerical_fracture",
        "whether it is watched where sound points lose each other on the grid, or points are split "
        "along their stretch before they do",
        {word({"ignore", "watch", "split"})},
        "ignore"}}};
  return info;
}

const BlockInfo& transfer_block() {
  static const BlockInfo info{
      "transfer",
      "A transfer with its options.",
      {{"tflip",
        "FLIP whose points carry a velocity gradient, the default",
        {block(nothing_block)},
        ""},
       {"flip",
        "changes of nodal velocity are added to those of the points",
        {block(nothing_block)},
        ""},
       {"apic",
        "points carry an affine velocity, and only what the grid has",
        {block(nothing_block)},
        ""},
       {"xpic",
        "a filter of an order against noise of points",
        {block([]() -> const BlockInfo& {
          static const BlockInfo xpic{
              "xpic", "Options of transfer xpic.", {{"order", "1: PIC", {integer(1, 10)}, "2"}}};
          return xpic;
        })},
        ""}},
      true};
  return info;
}

const BlockInfo& method_reference_block() {
  static const BlockInfo info{
      "method.reference",
      "The configuration on which gradients are taken, with its options.",
      {{"current", "where the points are", {block(nothing_block)}, ""},
       {"initial", "that of the start (total Lagrangian)", {block(nothing_block)}, ""},
       {"adaptive",
        "that of the start, renewed when points have been strained",
        {block([]() -> const BlockInfo& {
          static const BlockInfo adaptive{
              "method.reference.adaptive",
              "When the reference is renewed.",
              {{"strain",
                "largest Green-Lagrange strain before the current configuration becomes the "
                "reference",
                {number("1", Range::positive)},
                "0.3"}}};
          return adaptive;
        })},
        ""}},
      true};
  return info;
}

const BlockInfo& output_block() {
  static const BlockInfo info{
      "output",
      "What is written, and how often.",
      {{"frames", "between frames, 0: first and last", {number("s", Range::non_negative)}, "0"},
       {"history", "between rows, 0: every step", {number("s", Range::non_negative)}, "0"},
       {"checkpoint",
        "wall clock between checkpoints, 0: at the end or on a signal",
        {number("s", Range::non_negative)},
        "600"},
       {"fields", "extra fields of the frames", {list({word(field_names())})}, "[]"}}};
  return info;
}

const BlockInfo& contact_block() {
  static const BlockInfo info{
      "contact",
      "How bodies meet: they push, slide with Coulomb friction and part.",
      {{"normal",
        "how the normal between two bodies is found",
        {word({"volume_gradient", "logistic_regression"})},
        "volume_gradient"},
       {"friction", "Coulomb coefficient of all pairs", {number("1", Range::non_negative)}, "0"},
       {"walls",
        "Coulomb coefficient of sides that are walls and name none of their own",
        {number("1", Range::non_negative)},
        ""},
       {"pairs", "coefficients of single pairs", {list({block(contact_pair_block)})}, ""}}};
  return info;
}

const BlockInfo& contact_pair_block() {
  static const BlockInfo info{
      "contact.pairs",
      "The friction of one pair.",
      {{"between", "two bodies, for example [projectile, plate]", {list({text()}, 2, 2)}, kMust},
       {"friction",
        "Coulomb coefficient of this pair",
        {number("1", Range::non_negative)},
        kMust}}};
  return info;
}

}  // namespace krater::scene
