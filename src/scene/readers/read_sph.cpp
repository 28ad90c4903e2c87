// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "krater/materials/catalogue.hpp"
#include "scene/readers/readers.hpp"

namespace krater::scene {

namespace {

constexpr int kMostPerCell = 8;
constexpr double kLeastSmoothing = 1, kMostSmoothing = 2;

/// A gas, or the products of an explosive: its energy is heat, and it expands without end.
bool expands(const MaterialOptions& m) {
  if (!m.eos || m.strength || m.model) return false;
  const MaterialConstants constants{m.density, m.shear_modulus, m.initial_temperature};
  return thermal_energy_at_start(m.eos->law, m.eos->values.data(), constants).has_value();
}

}  // namespace

int particles_per_cell(const BodyOptions& body, const Scene& scene) {
  return std::max(1, static_cast<int>(std::lround(scene.grid.cell / body.sph->spacing)));
}

Node read_sph(const Node* node, const Node& place, BodyOptions& body, Reading& reading) {
  const Scene& scene = reading.scene;
  Block block{sph_block(), node, place.path, place, reading.problems};
  body.sph = SphOptions{};
  SphOptions& out = *body.sph;
  out.spacing = block.number("spacing", scene.grid.cell / scene.method.points_per_direction);
  const double share = scene.grid.cell / out.spacing;
  if (!(std::abs(share - std::round(share)) < 1e-6 * share) || share < 0.5 || share > kMostPerCell)
    block.fail(
        "spacing must be grid.cell divided by a whole number from 1 to 8: measures and the "
        "lattice count by cells; change one of the two");
  out.smoothing = block.number("smoothing", out.smoothing);
  if (out.smoothing < kLeastSmoothing || out.smoothing > kMostSmoothing)
    block.fail("smoothing must be from 1 (26 neighbours in 3d) to 2 (250)");
  out.zero_energy = block.number("zero_energy", out.zero_energy);
  out.artificial_stress = block.number("artificial_stress", out.artificial_stress);
  out.kernel = block.choice<SphKernel>("kernel",
                                       {{"cubic_spline", SphKernel::cubic_spline},
                                        {"wendland_c2", SphKernel::wendland_c2},
                                        {"quadratic", SphKernel::quadratic}},
                                       out.kernel);
  out.correction = block.choice<SphCorrection>(
      "correction", {{"linear", SphCorrection::linear}, {"none", SphCorrection::none}},
      out.correction);
  out.reference = static_cast<SphReference>(read_reference(block, out.refresh_strain, reading));
  return block.finish();
}

namespace {

void check_particles_of(const BodyOptions& body, const Node& node, Reading& reading) {
  const Scene& scene = reading.scene;
  const auto fail = [&](const Node& at, const std::string& what) {
    reading.problems.add(at.file, at.line, at.path, "a body of kinematics sph " + what);
  };
  if (const Node* points = node.find("points"))
    for (const char* key : {"per_direction", "lattice", "zones"})
      if (const Node* given = points->find(key))
        fail(*given, "has particles on a lattice of its own spacing: leave this key out");
  if (body.material >= 0 &&
      scene.materials[static_cast<std::size_t>(body.material)].failure == FailureAction::remove)
    fail(node,
         "keeps its failed particles: use failure: {action: strength_loss} in its material, or "
         "kinematics: mpm");
  if (body.sph->reference == SphReference::initial && body.material >= 0 &&
      expands(scene.materials[static_cast<std::size_t>(body.material)]))
    fail(*node.find("kinematics"),
         "of a gas has no use for sph: {reference: initial}: it keeps the neighbours of the start, "
         "which an expansion parts; use reference: current, or kinematics: mpm");
  if (body.rigid()) fail(*node.find("rigid"), "cannot be rigid: leave one of the two out");
}

}  // namespace

void check_particles(Reading& reading) {
  const Scene& scene = reading.scene;
  const BodyOptions* first = nullptr;
  bool points = false;
  for (const BodyOptions& body : scene.bodies) {
    points = points || (!body.sph && !body.mesh && !body.rigid());
    if (!body.sph) continue;
    if (first == nullptr) first = &body;
    check_particles_of(body, *reading.root.find("bodies")->find(body.name), reading);
  }
  if (first == nullptr) return;
  const Node& place = *reading.root.find("bodies")->find(first->name)->find("kinematics");
  const auto fail = [&](const std::string& what) {
    reading.problems.add(place.file, place.line, place.path, "kinematics sph " + what);
  };
  if (scene.frame == Frame::axisymmetric)
    fail(
        "is not known in axial symmetry: use frame: 3d (a quarter with x_min and y_min: symmetry)"
        ", plane_strain, or another kinematics");
  if (scene.bodies.size() > 1 && !scene.contact.active)
    fail("meets other bodies by contact only: add a block contact: {friction: 0}");
  if (scene.contact.normal != ContactNormal::volume_gradient)
    fail("meets other bodies by contact: {normal: volume_gradient}");
  const MethodOptions& method = scene.method;
  if (points && (method.shape != Shape::quadratic_bspline || method.update != Update::usl ||
                 method.transfer == Transfer::xpic))
    fail(
        "meets bodies of points whose method has shape quadratic_bspline, update usl and a "
        "transfer other than xpic");
  if (scene.method.reference != Reference::current)
    fail(
        "has a reference of its own: leave out method.reference and say sph: {reference: initial}");
  refuse_idle("sph", place, reading);
}

}  // namespace krater::scene
