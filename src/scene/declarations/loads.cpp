// SPDX-License-Identifier: GPL-3.0-or-later
// What drives a scene: loads, damping, detonators; functions of time.
#include "scene/declarations/declarations.hpp"

namespace krater::scene {

using namespace forms;

std::vector<Form> function_of_time(const char* unit) {
  return {number(unit), text(), block(time_table_block)};
}

const BlockInfo& time_table_block() {
  static const BlockInfo info{
      "table",
      "A function of time: linear between its rows, constant beyond.",
      {{"table", "[[time, value], ...]", {list({list({number("")}, 2, 2)}, 1)}, kMust}}};
  return info;
}

const BlockInfo& damping_block() {
  static const BlockInfo info{"damping",
                              "Damping by mass: motion falls with exp(-eta t).",
                              {{"mass",
                                "eta of the force -eta m v on every mass",
                                {number("1/s", Range::positive)},
                                kMust}}};
  return info;
}

const BlockInfo& loads_block() {
  static const BlockInfo info{
      "loads", "Loads by name.", {{"*", "a name of your own", {block(load_block)}, ""}}};
  return info;
}

const BlockInfo& load_block() {
  static const auto components = [](const char* unit) {
    std::vector<Form> items = function_of_time(unit);
    return list(std::move(items), 2, 3);
  };
  static const BlockInfo info{
      "load",
      "A load on part of a body's surface: one of pressure, traction and velocity.",
      {{"body", "a deformable body, or a list of them", {text(), list({text()})}, kMust},
       {"face",
        "z_max: the surface whose outward normal is +z; without it a pressure acts all "
        "around",
        {text()},
        ""},
       {"where",
        "bounds: which part, by the place of the material at the start",
        {block(bounds_block)},
        ""},
       {"inside",
        "a shape: which part, by the place of the material at the start",
        {block(shape_block)},
        ""},
       {"pressure", "follows the surface as it is now", function_of_time("Pa"), ""},
       {"traction", "components, per area of the face as it is now", {components("Pa")}, ""},
       {"velocity",
        "components or free; moves the first layer of cells",
        {components("m/s")},
        ""}}};
  return info;
}

const BlockInfo& detonator_block() {
  static const BlockInfo info{"detonator",
                              "Where a front starts: one of point, line and plane.",
                              {{"point", "a place", {vector("m")}, ""},
                               {"line", "its two ends", {list({vector("m")}, 2, 2)}, ""},
                               {"plane", "a plane", {block(detonator_plane_block)}, ""},
                               {"time", "when it lights", {number("s")}, "0"}}};
  return info;
}

const BlockInfo& detonator_plane_block() {
  static const BlockInfo info{"detonator.plane",
                              "A plane that lights.",
                              {{"through", "a point of the plane", {vector("m")}, kMust},
                               {"normal", "for example [0, 1]", {vector("1")}, kMust}}};
  return info;
}

}  // namespace krater::scene
