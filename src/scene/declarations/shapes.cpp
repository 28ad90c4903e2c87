// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes of bodies and regions.
#include <utility>

#include "scene/declarations/declarations.hpp"

namespace krater::scene {

using namespace forms;

namespace {

KeyInfo length(const char* key, const char* meaning) {
  return {key, meaning, {number("m", Range::positive)}, kMust};
}
KeyInfo place(const char* key, const char* meaning) {
  return {key, meaning, {vector("m")}, "[0, 0, 0]"};
}
KeyInfo plain_axis(const char* fallback = "z") {
  return {"axis", "along which it lies", {word({"x", "y", "z"})}, fallback};
}
KeyInfo signed_axis() {
  return {"axis", "from the base on", {word({"x", "y", "z", "-x", "-y", "-z"})}, "z"};
}
KeyInfo corners(const char* meaning) {
  return {"polygon", meaning, {list({list({number("m")}, 2, 2)})}, kMust};
}
KeyInfo inner() {
  return {"shape", "the shape that is moved, turned or scaled", {block(shape_block)}, kMust};
}
KeyInfo bound(const char* key, const char* meaning, const char* fallback) {
  return {key, meaning, {number("m")}, fallback};
}

std::vector<BlockInfo> plain_solids() {
  return {
      {"cylinder",
       "A cylinder.",
       {length("radius", "radius"), length("height", "length along its axis"),
        place("base", "centre of its lower end"), plain_axis()}},
      {"box",
       "A box along the axes; of two components it is a section, 1 m thick.",
       {{"min", "lower corner", {vector("m")}, kMust},
        {"max", "upper corner", {vector("m")}, kMust}}},
      {"sphere", "A sphere.", {length("radius", "radius"), place("center", "its centre")}},
      {"tube",
       "A tube.",
       {length("inner_radius", "radius of the bore"), length("outer_radius", "outer radius"),
        length("height", "length along its axis"), place("base", "centre of its lower end"),
        signed_axis()}},
      {"cone",
       "A cone or its frustum.",
       {{"radius", "radius at the base", {number("m", Range::non_negative)}, kMust},
        {"top_radius", "radius at the far end, 0: a tip", {number("m", Range::non_negative)}, "0"},
        length("height", "length along its axis"),
        place("base", "centre of its base"),
        signed_axis()}},
      {"torus",
       "A torus.",
       {length("major_radius", "from the axis to the middle of the tube"),
        length("minor_radius", "radius of the tube"), place("center", "its centre"),
        signed_axis()}},
      {"ellipsoid",
       "An ellipsoid.",
       {{"semi_axes", "[r, z] or [x, y, z]", {vector("m")}, kMust}, place("center", "its centre")}},
      {"ogive",
       "A cylinder with an ogival nose.",
       {length("radius", "radius"),
        length("length", "from the flat base to the tip"),
        {"crh",
         "calibre-radius-head: radius of the nose's arc over the diameter",
         {number("1", Range::positive)},
         kMust},
        place("base", "centre of the flat base"),
        signed_axis()}}};
}

/// Drawn out of polygons, read from files, made of other shapes.
std::vector<BlockInfo> made_solids() {
  return {
      {"slab",
       "All between two planes; without one of them it ends where the grid does.",
       {plain_axis(), bound("min", "lower bound", ""), bound("max", "upper bound", "")}},
      {"extrusion",
       "A polygon, drawn out across its plane.",
       {corners("[[x, z], ...], the other two axes in order"), plain_axis("y"),
        bound("min", "lower bound", kMust), bound("max", "upper bound", kMust)}},
      {"revolution",
       "A polygon, revolved.",
       {corners("[[r, z], ...]"), place("base", "origin of the polygon"), signed_axis()}},
      {"surface",
       "What a surface of triangles bounds.",
       {{"file", "an .stl, .off, .obj or .ply file beside the scene", {text()}, kMust},
        {"unit", "of the file's numbers, for example mm", {text()}, kMust},
        {"repair", "what may be mended", {block(repair_block)}, ""},
        {"checksum", "of the file that is meant; resolved.yaml has it", {text()}, ""}}},
      {"mesh",
       "What the elements of a file fill.",
       {{"file", "a .msh, .inp or .k file beside the scene", {text()}, kMust},
        {"unit", "of the file's numbers, for example mm", {text()}, kMust},
        {"part", "which part, where there are several", {text()}, ""},
        {"merge_nodes",
         "nodes nearer than this become one, 0: none",
         {number("m", Range::non_negative)},
         "0"},
        {"checksum", "of the file that is meant; resolved.yaml has it", {text()}, ""}}},
      {"move", "A shape elsewhere.", {{"by", "a displacement", {vector("m")}, kMust}, inner()}},
      {"rotate",
       "A shape, turned.",
       {plain_axis(),
        {"angle", "right-handed about the axis", {number("rad")}, kMust},
        place("about", "a point of the axis"),
        inner()}},
      {"scale",
       "A shape, stretched.",
       {{"by",
         "a factor, or one per axis",
         {number("1", Range::positive), list({number("1", Range::positive)}, 3, 3)},
         kMust},
        place("about", "the point that stays"),
        inner()}},
  };
}

}  // namespace

const BlockInfo& shape_block() {
  static const std::vector<BlockInfo> made = [] {
    std::vector<BlockInfo> all = plain_solids();
    for (BlockInfo& solid : made_solids()) all.push_back(std::move(solid));
    return all;
  }();
  static const BlockInfo info = [] {
    BlockInfo shapes{
        "shape", "One shape. Positions have two components, r or x and z, or three.", {}};
    shapes.one_of = true;
    for (const BlockInfo& solid : made) {
      const BlockInfo* at = &solid;
      shapes.keys.push_back(
          {solid.name, solid.meaning, {block([at]() -> const BlockInfo& { return *at; })}, ""});
    }
    for (const auto& [name, meaning] : {std::pair{"union", "all of these shapes"},
                                        {"intersection", "what all of them share"},
                                        {"difference", "the first without all others"}})
      shapes.keys.push_back({name, meaning, {list({block(shape_block)})}, ""});
    return shapes;
  }();
  return info;
}

const BlockInfo& repair_block() {
  static const BlockInfo info{
      "surface.repair",
      "What may be mended in a surface; nothing else is.",
      {{"merge_vertices",
        "vertices nearer than this become one, 0: none",
        {number("m", Range::non_negative)},
        "0"},
       {"drop_facets", "doubled and flat facets go", {flag()}, "false"},
       {"orient", "facets are turned so that normals point outwards", {flag()}, "false"},
       {"close_holes",
        "holes smaller than this are closed, 0: none",
        {number("m", Range::non_negative)},
        "0"}}};
  return info;
}

}  // namespace krater::scene
