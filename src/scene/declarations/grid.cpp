// SPDX-License-Identifier: GPL-3.0-or-later
// The grid, its sides and its finer cells; regions.
#include "krater/grid/levels.hpp"
#include "scene/declarations/declarations.hpp"

namespace krater::scene {

using namespace forms;

const BlockInfo& grid_block() {
  static const BlockInfo info{
      "grid",
      "The background grid: a box of equal cells.",
      {{"cell", "spacing of the nodes", {number("m", Range::positive)}, kMust},
       {"box", "the domain", {block(box_block)}, kMust},
       {"boundary", "what each side of the domain does", {block(boundary_block)}, ""},
       {"refine", "rules for finer cells", {word({"none"}), list({block(refine_block)})}, ""},
       {"merge", "points that finer cells leave behind become one again", {flag()}, "false"}}};
  return info;
}

const BlockInfo& box_block() {
  static const BlockInfo info{
      "grid.box",
      "Opposite corners of the domain, [r or x, z] or [x, y, z]. An open side moves out to the "
      "next "
      "node line; in 3d a box of two components that begins at the axis is revolved.",
      {{"min", "lower corner", {vector("m")}, kMust},
       {"max", "upper corner", {vector("m")}, kMust}}};
  return info;
}

const BlockInfo& boundary_block() {
  static const auto side = [](const char* key, const char* meaning) {
    return KeyInfo{key,
                   meaning,
                   {word({"open", "symmetry", "axis", "sticky", "wall"}), block(side_block)},
                   "open"};
  };
  static const BlockInfo info{
      "grid.boundary",
      "Conditions of the sides. In the 2D frames r and x are one axis; in 3d r_max stands for all "
      "four sides across z.",
      {side("r_min", "inner side; of a box that begins at 0 the axis"), side("r_max", "outer side"),
       side("x_min", "lower x"), side("x_max", "upper x"), side("y_min", "lower y (3d)"),
       side("y_max", "upper y (3d)"), side("z_min", "lower z"), side("z_max", "upper z")}};
  return info;
}

const BlockInfo& side_block() {
  static const auto wall = []() -> const BlockInfo& {
    static const BlockInfo options{"wall",
                                   "Options of a wall.",
                                   {{"friction",
                                     "Coulomb coefficient",
                                     {number("1", Range::non_negative)},
                                     "(contact.walls, else 0)"}}};
    return options;
  };
  static const BlockInfo info{
      "side",
      "The condition of a side of the domain.",
      {{"open", "points leave, and are booked as removed", {block(nothing_block)}, ""},
       {"symmetry", "what is beyond is the mirror image", {block(nothing_block)}, ""},
       {"axis", "the axis of revolution", {block(nothing_block)}, ""},
       {"sticky", "holds what reaches it, all components", {block(nothing_block)}, ""},
       {"wall", "a rigid body at rest that pushes and does not pull", {block(wall)}, ""},
       {"velocity",
        "a rigid plane that moves into the domain: a piston",
        {vector("m/s"), block(speed_block), block(driven_side_block)},
        ""},
       {"pressure", "an open side that presses on the bodies that reach it at the start",
        function_of_time("Pa"), ""}},
      true};
  return info;
}

const BlockInfo& driven_side_block() {
  static const BlockInfo info{
      "driven side",
      "A moving side on which material slides.",
      {{"of", "velocity of the side", {vector("m/s"), block(speed_block)}, kMust},
       {"friction",
        "Coulomb coefficient; without it material sticks",
        {number("1", Range::non_negative)},
        "0"}}};
  return info;
}

const BlockInfo& refine_block() {
  static const BlockInfo info{
      "grid.refine",
      "A rule for finer cells; one of region, follow and where.",
      {{"level", "how often the cell is halved", {integer(1, kMostLevels)}, "1"},
       {"region", "a box of the section, or any shape", {block(shape_block)}, ""},
       {"follow", "a body around which cells are finer", {text()}, ""},
       {"margin",
        "how far around the body cells are finer",
        {number("m", Range::non_negative)},
        kWhereUsed},
       {"where", "points of which a field is large", {block(refine_where_block)}, ""}}};
  return info;
}

const BlockInfo& refine_where_block() {
  static const BlockInfo info{"grid.refine.where",
                              "Cells are finer where a scalar of the points exceeds a threshold.",
                              {{"field", "a scalar", {word(field_names())}, kMust},
                               {"above", "threshold of the field", {number("")}, kMust}}};
  return info;
}

const BlockInfo& corners_block() {
  static const BlockInfo info{"corners",
                              "A box by two corners, [r or x, z] or [x, y, z].",
                              {{"min", "lower corner", {vector("m")}, kMust},
                               {"max", "upper corner", {vector("m")}, kMust}}};
  return info;
}

const BlockInfo& bounds_block() {
  static const auto bound = [](const char* key, const char* meaning) {
    return KeyInfo{key, meaning, {number("m")}, ""};
  };
  static const BlockInfo info{
      "bounds",
      "Bounds of a region; at least one.",
      {bound("r_min", "lower r (2D)"), bound("r_max", "upper r (2D)"), bound("x_min", "lower x"),
       bound("x_max", "upper x"), bound("y_min", "lower y (3d)"), bound("y_max", "upper y (3d)"),
       bound("z_min", "lower z"), bound("z_max", "upper z")}};
  return info;
}

}  // namespace krater::scene
