// SPDX-License-Identifier: GPL-3.0-or-later
#include <iomanip>
#include <sstream>

#include "krater/geometry/meshes/mesh.hpp"
#include "krater/materials/catalogue.hpp"
#include "scene/readers/readers.hpp"

namespace krater::scene {

namespace {

/// Five digits, for messages.
std::string rounded(double value) {
  std::ostringstream text;
  text << std::setprecision(5) << value;
  return text.str();
}

std::string problem_of(const MaterialOptions& material, double largest, double length,
                       const std::string& what) {
  return "model " + material.model->name + " softens by an energy per area: in " + what + " of " +
         rounded(length) + " m it would snap back, the largest is " + rounded(largest) +
         " m (2 E G_f/f_t^2 or less); use a smaller one, or a larger fracture_energy";
}

}  // namespace

std::optional<double> softening_length(const MaterialOptions& material) {
  if (!material.model) return std::nullopt;
  return largest_length(material.model->law, material.model->values.data(),
                        {material.density, material.shear_modulus, material.initial_temperature});
}

void take_shear_modulus(MaterialOptions& material, Block& block, Reading& reading) {
  const std::optional<double> own =
      own_shear_modulus(material.model->law, material.model->values.data(),
                        {material.density, material.shear_modulus, material.initial_temperature});
  if (!own) return;
  if (material.shear_modulus > 0)
    block.fail("model " + material.model->name + " has its own shear modulus, " + rounded(*own) +
               " Pa at rest: remove the material's elastic constants");
  material.shear_modulus = *own;
  const double c0 = sound_speed_at_rest(material.model->law, material.model->values.data(),
                                        {material.density, *own, material.initial_temperature})
                        .value();
  const double K = material.density * c0 * c0, G = *own;
  const std::optional<double> largest = softening_length(material);
  std::string more;
  for (const DerivedConstant& d :
       derived_constants(material.model->law, material.model->values.data(),
                         {material.density, G, material.initial_temperature}))
    more += std::string{", "} + d.name + " = " + rounded(d.value) +
            (std::string_view{d.unit} == "1" ? "" : std::string{" "} + d.unit);
  reading.scene.notes.push_back(
      material.model->where + ": generated from the strength, uncalibrated: E = " +
      rounded(9 * K * G / (3 * K + G)) + " Pa, Poisson's ratio " +
      rounded((3 * K - 2 * G) / (2 * (3 * K + G))) + ", K = " + rounded(K) + " Pa" +
      (largest ? ", softens by its fracture energy in cells up to " + rounded(*largest) + " m"
               : ", softens by no energy") +
      more);
}

void check_softening(const MaterialOptions& material, double length, Block& point) {
  const std::optional<double> largest = softening_length(material);
  if (largest && length > *largest)
    point.fail(problem_of(material, *largest, length, "a point of length"));
}

namespace {

/// Over what a body's softening localises, and where a user sets it.
struct Width {
  double length;  ///< [m]
  const char* what;
  const Node& place;
  std::string path;
};
Width width_of(const BodyOptions& body, const Reading& reading) {
  const Scene& scene = reading.scene;
  const Node* grid = reading.root.find("grid");
  if (body.material_points())
    return {scene.grid.cell, "cells", grid ? *grid : reading.root, "grid.cell"};
  const Node* own = reading.root.find("bodies")->find(body.name);
  const Node& place = own ? *own : reading.root;
  const std::string path = "bodies." + body.name + ".kinematics";
  if (body.sph) return {body.sph->spacing, "particles", place, path};
  const double edge = body.mesh->mesh ? mesh_quality(*body.mesh->mesh).longest : body.mesh->element;
  return {edge, "elements", place, path};
}

}  // namespace

void check_softening(Reading& reading) {
  const Scene& scene = reading.scene;
  for (const BodyOptions& body : scene.bodies) {
    if (body.material < 0 || body.rigid()) continue;
    const MaterialOptions& m = scene.materials[static_cast<std::size_t>(body.material)];
    const std::optional<double> largest = m.model ? softening_length(m) : std::nullopt;
    if (!largest) continue;
    const Width width = width_of(body, reading);
    if (width.length <= *largest) continue;
    reading.problems.add(
        width.place.file, width.place.line, width.path,
        "body " + body.name + ": " + problem_of(m, *largest, width.length, width.what));
  }
}

}  // namespace krater::scene
