// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "krater/geometry/meshes/mesh.hpp"
#include "krater/geometry/meshes/round_mesh.hpp"
#include "scene/readers/readers.hpp"

namespace krater::scene {

namespace {

using Kind = HourglassOptions::Kind;

void read_hourglass(Block& mesh, HourglassOptions& out, Reading& reading) {
  const Node* node = mesh.find("hourglass");
  if (node == nullptr || node->kind == Node::Kind::scalar) {
    out.kind = mesh.choice<Kind>("hourglass",
                                 {{"assumed_strain", Kind::assumed_strain},
                                  {"stiffness", Kind::stiffness},
                                  {"viscous", Kind::viscous}},
                                 Kind::assumed_strain);
    return;
  }
  Block block{hourglass_block(), node, node->path, *node, reading.problems};
  const auto viscous = block.optional_number("viscous");
  const auto stiffness = block.optional_number("stiffness");
  if (viscous.has_value() == stiffness.has_value())
    block.fail(*node,
               "expected assumed_strain, stiffness, viscous, {stiffness: 0.05} or {viscous: 0.1}");
  else if (viscous)
    out = {.kind = Kind::viscous, .viscous = *viscous};
  else
    out = {.kind = Kind::stiffness, .stiffness = *stiffness};
  mesh.record("hourglass", block.finish());
}

/// `failure: {action: erode | convert, when: {...}}`.
void read_erosion(Block& mesh, MeshOptions& options, Reading& reading) {
  const Node* node = mesh.find("failure");
  if (node == nullptr) return;
  ErosionOptions& out = options.erosion;
  Block block{element_failure_block(), node, node->path, *node, reading.problems};
  options.converts = block.choice<bool>("action", {{"erode", false}, {"convert", true}}, false);
  if (const Node* inner = block.require("when", "for instance when: {plastic_strain: 1.0}")) {
    Block when{element_limits_block(), inner, inner->path, *inner, reading.problems};
    const auto limit = [&](const char* name, double& to) {
      if (const auto value = when.optional_number(name)) to = *value;
    };
    out.failed = when.flag("failed", false);
    limit("plastic_strain", out.plastic_strain);
    limit("step", out.step);
    limit("jacobian", out.jacobian);
    limit("least_volume", out.volume_ratio[0]);
    limit("greatest_volume", out.volume_ratio[1]);
    if (!(out.volume_ratio[0] < 1) || !(out.volume_ratio[1] > 1))
      block.fail(*inner, "least_volume must lie below 1 and greatest_volume above");
    if (out.jacobian >= 1)
      block.fail(*inner,
                 "jacobian must lie below 1, which every corner of a brick has: 0.05 is "
                 "an element that has collapsed");
    if (!out.any())
      block.fail(*inner,
                 "names nothing: failed, plastic_strain, least_volume, greatest_volume, "
                 "jacobian or step");
    block.record("when", when.finish());
  }
  mesh.record("failure", block.finish());
}

}  // namespace

int read_reference(Block& parent, double& strain, Reading& reading) {
  const Node* node = parent.find("reference");
  if (node == nullptr || node->kind == Node::Kind::scalar)
    return parent.choice<int>("reference", {{"current", 0}, {"initial", 1}, {"adaptive", 2}}, 0);
  Block block{body_reference_block(), node, node->path, *node, reading.problems};
  if (const Node* inner = block.require("adaptive", "or current, initial, adaptive")) {
    Block adaptive{member(body_reference_block(), "adaptive"), inner, inner->path, *inner,
                   reading.problems};
    strain = adaptive.number("strain", strain);
    block.record("adaptive", adaptive.finish());
  }
  parent.record("reference", block.finish());
  return 2;
}

namespace {

/// Elements of a file have the edges they have.
void read_edge(Block& mesh, BodyOptions& body, Reading& reading) {
  body.mesh->element = reading.scene.grid.cell;
  if (body.solid == nullptr || body.solid->elements() == nullptr)
    body.mesh->element = mesh.number("element", reading.scene.grid.cell);
  else if (const Node* edge = mesh.find("element"))
    mesh.fail(*edge, "the elements are those of the file: leave this key out");
}

}  // namespace

Node read_kinematics(const Node& node, BodyOptions& body, Reading& reading) {
  if (node.kind == Node::Kind::scalar) {
    if (node.text == "mpm") return string_node("mpm");
    if (node.text == "sph") {
      read_sph(nullptr, node, body, reading);
      return string_node("sph");
    }
    if (node.text != "lagrangian_mesh") {
      report_unknown(node, "kinematics", node.text, {"mpm", "lagrangian_mesh", "sph"},
                     reading.problems);
      return node;
    }
    body.mesh = MeshOptions{};
    body.mesh->element = reading.scene.grid.cell;
    return string_node("lagrangian_mesh");
  }
  Block block{kinematics_block(), &node, node.path, node, reading.problems};
  if (node.find("sph") && node.find("lagrangian_mesh")) {
    block.fail("gives lagrangian_mesh and sph: a body has one of the two");
    return node;
  }
  if (const Node* inner = block.find("sph")) {
    block.record("sph", read_sph(inner, *inner, body, reading));
    return block.finish();
  }
  body.mesh = MeshOptions{};
  if (const Node* inner = block.require("lagrangian_mesh", "or sph, or kinematics: mpm")) {
    Block mesh{lagrangian_mesh_block(), inner, inner->path, *inner, reading.problems};
    read_edge(mesh, body, reading);
    read_hourglass(mesh, body.mesh->hourglass, reading);
    body.mesh->reference =
        static_cast<ElementReference>(read_reference(mesh, body.mesh->refresh_strain, reading));
    read_erosion(mesh, *body.mesh, reading);
    block.record("lagrangian_mesh", mesh.finish());
  }
  return block.finish();
}

namespace {

/// Does the body fill the box around it?
bool is_block(const BodyOptions& body, const Scene& scene, const Box& box) {
  const double content = body.solid->part(scene.frame, {scene.grid.min, scene.grid.max}).section;
  double whole = 1;
  for (int a = 0; a < dimension(scene.frame); ++a) whole *= box.length(a);
  return std::abs(content / whole - 1) < 1e-9;
}

/// What lies on a side of the domain but for the digits of a file lies on it; what lies beyond is
/// told.
void fit_to_domain(Mesh& mesh, const Scene& scene) {
  const double near = 1e-6 * mesh_quality(mesh).shortest;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    for (int axis = 0; axis < dimension(scene.frame); ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      double& x = mesh.nodes[n][a];
      for (const double plane : {scene.grid.min[a], scene.grid.max[a]})
        if (std::abs(x - plane) <= near) x = plane;
      if (x >= scene.grid.min[a] && x <= scene.grid.max[a]) continue;
      throw std::invalid_argument(
          fmt::format("has a node at {} = {:g} m, outside grid.box: elements of a file cannot be "
                      "cut; move the body, or make the box larger",
                      axis_name(scene.frame, axis), x));
    }
}

/// The mesh of a body that is no block.
void make_mesh(BodyOptions& body, const Scene& scene) {
  const Box domain{scene.grid.min, scene.grid.max};
  Mesh mesh{};
  if (body.solid->elements() != nullptr) {
    mesh = *body.solid->elements();
    fit_to_domain(mesh, scene);
  } else {
    mesh = round_mesh(*body.solid, scene.frame, domain, body.mesh->element);
  }
  body.point_estimate = static_cast<double>(mesh.element_count());
  body.mesh->mesh = std::make_shared<const Mesh>(std::move(mesh));
}

void check_mesh(BodyOptions& body, const Node& node, Reading& reading) {
  const Scene& scene = reading.scene;
  const auto fail = [&](const Node& at, const std::string& what) {
    reading.problems.add(at.file, at.line, at.path, what);
  };
  const std::string only = "a body of kinematics lagrangian_mesh ";
  if (const Node* points = node.find("points"))
    fail(*points, only + "has elements, no points: leave this key out");
  if (body.material >= 0 &&
      scene.materials[static_cast<std::size_t>(body.material)].failure == FailureAction::remove) {
    body.mesh->erosion.failed = true;
    if (body.mesh->converts)
      fail(*node.find("kinematics"),
           only +
               "whose elements become points has a material that removes what fails: leave out "
               "failure: remove of its material, or say action: erode");
  }
  for (const BodyOptions& other : scene.bodies)
    if (body.mesh->converts && other.name == body.name + kPointsOf)
      fail(*node.find("kinematics"),
           only + "whose elements become points writes these as '" + other.name +
               "', which is the name of another body: rename one of the two");
  if (body.rigid()) fail(*node.find("rigid"), only + "cannot be rigid: leave one of the two out");
  const Box box = intersection(body.solid->extent(scene.frame), {scene.grid.min, scene.grid.max},
                               dimension(scene.frame));
  if (body.solid->elements() != nullptr || !is_block(body, scene, box)) {
    try {
      make_mesh(body, scene);
    } catch (const std::invalid_argument& error) {
      fail(*node.find("shape"), only + error.what());
    }
    return;
  }
  body.point_estimate = 1;
  const std::array<int, 3> counts =
      elements_along(scene.frame, box.min, box.max, body.mesh->element);
  for (int a = 0; a < dimension(scene.frame); ++a)
    body.point_estimate *= counts[static_cast<std::size_t>(a)];
}

/// What bodies of elements ask of those of points.
template <class Fail>
void check_among_points(const Fail& fail, const Scene& scene) {
  if (!scene.contact.active)
    fail("meets bodies of points by contact only: add a block contact: {friction: 0}");
  const MethodOptions& method = scene.method;
  if (method.shape != Shape::quadratic_bspline || method.update != Update::usl ||
      method.transfer == Transfer::xpic)
    fail(
        "meets bodies of points whose method has shape quadratic_bspline, update usl and a "
        "transfer other than xpic");
}

/// What the whole scene must be.
void check_alone(const Node& place, Reading& reading) {
  const Scene& scene = reading.scene;
  const auto fail = [&](const std::string& what) {
    reading.problems.add(place.file, place.line, place.path, "kinematics lagrangian_mesh " + what);
  };
  if (std::any_of(scene.bodies.begin(), scene.bodies.end(),
                  [](const BodyOptions& body) { return !body.mesh || body.mesh->converts; }))
    check_among_points(fail, scene);
  if (scene.method.reference != Reference::current)
    fail(
        "has a reference of its own: leave out method.reference, and give kinematics: "
        "{lagrangian_mesh: {reference: initial}}");
  refuse_idle("lagrangian_mesh", place, reading);
}

}  // namespace

void refuse_idle(const std::string& kinematics, const Node& place, Reading& reading) {
  const Scene& scene = reading.scene;
  const auto fail = [&](const std::string& what) {
    reading.problems.add(place.file, place.line, place.path,
                         "kinematics " + kinematics + " " + what);
  };
  if (scene.method.energy_alpha != 0.5)
    fail("takes Algorithm 1 with alpha 1/2 only: leave out method.energy_alpha");
  if (!scene.detonators.empty()) fail("is not lit by detonators yet; use kinematics: mpm");
}

void check_meshes(Reading& reading) {
  const Node& bodies = *reading.root.find("bodies");
  bool told = false;
  for (BodyOptions& body : reading.scene.bodies) {
    if (!body.mesh) continue;
    const Node& node = *bodies.find(body.name);
    check_mesh(body, node, reading);
    if (!told) check_alone(*node.find("kinematics"), reading);
    told = true;
  }
}

}  // namespace krater::scene
