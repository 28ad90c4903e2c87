// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/app/check.hpp"

#include "krater/app/effects.hpp"
#include "krater/app/level_report.hpp"
#include "krater/geometry/meshes/mesh.hpp"
#include "krater/geometry/seeds/column.hpp"
#include "krater/simulation/rigid_course.hpp"

namespace krater {

namespace {

Json texts(const std::vector<std::string>& lines) {
  Json out = Json::array();
  for (const std::string& line : lines) out.items.push_back(Json::of(line));
  return out;
}

template <class Numbers>
Json numbers(const Numbers& values) {
  Json out = Json::array();
  for (const double x : values) out.items.push_back(Json::of(x));
  return out;
}

Json moments_json(const VolumeMoments& moments, double density) {
  auto inertia = moments.inertia();
  for (double& i : inertia) i = density * i + 0.0;
  Json out;
  out["volume"] = Json::of(moments.volume);
  out["mass"] = Json::of(density * moments.volume);
  out["centroid"] = numbers(moments.centroid());
  out["inertia"] = numbers(inertia);
  return out;
}

/// The body as drawn, in the domain, and what its points make of it.
void add_shape(const Checked& of, const Body& body, Json& out) {
  bool exact = false;
  const double density = body.material().density;
  Json solid = moments_json(
      moments_in(*body.options().solid, of.scene.frame, domain_box(of.scene), &exact), density);
  solid["closed_form"] = Json::of(exact);
  out["solid"] = solid;
  if (of.coarser == 1) out["of_points"] = moments_json(body.seed_moments(), density);
  out["thickness_in_cells"] = Json::of(of.coarser * body.thickness() / body.seed_cell());
}

Json mesh_json(const Mesh& mesh) {
  const MeshQuality quality = mesh_quality(mesh);
  Json out;
  out["shortest_edge"] = Json::of(quality.shortest);
  out["longest_edge"] = Json::of(quality.longest);
  out["least_scaled_jacobian"] = Json::of(quality.least_jacobian);
  return out;
}

const char* kinematics_of(const BodyOptions& body) {
  return body.mesh ? "lagrangian_mesh" : body.rigid() ? "rigid" : "mpm";
}

Json body_json(const Checked& of, int index) {
  const Body& body = *of.sim.bodies()[static_cast<std::size_t>(index)];
  const BodyOptions& options = body.options();
  const Totals t = of.sim.totals(index);
  Json out, stages = Json::array();
  for (const NamedStage& s : body.stages()) stages.items.push_back(Json::of(s.name));
  out["name"] = Json::of(body.name());
  out["material"] = Json::of(body.material().name);
  if (!body.material().card.empty()) out["card"] = Json::of(body.material().card);
  out["kinematics"] = Json::of(kinematics_of(options));
  out[options.mesh ? "elements" : "points"] =
      Json::of(of.coarser == 1 ? t.count : options.point_estimate);
  out["mass"] = Json::of(t.mass);
  if (options.mesh) {
    if (options.mesh->mesh) out["mesh"] = mesh_json(*options.mesh->mesh);
  } else {
    add_shape(of, body, out);
    if (!options.rigid()) out["pressure_on_grid"] = Json::of(body.pressure_on_grid(of.sim.scene()));
  }
  out["stages"] = stages;
  out["bytes_per_point"] = Json::of(body.layout().stride());
  return out;
}

Json contact_json(const Scene& scene) {
  Json pairs = Json::array();
  if (!scene.contact.active) return pairs;
  for (int a = 0; a < scene.contact.fields; ++a)
    for (int b = a + 1; b < scene.contact.fields; ++b) {
      Json& pair = pairs.items.emplace_back();
      pair["bodies"] = texts({scene.bodies[static_cast<std::size_t>(a)].name,
                              scene.bodies[static_cast<std::size_t>(b)].name});
      pair["friction"] = Json::of(scene.contact.friction_of(a, b));
    }
  return pairs;
}

Json forecast_json(const Forecast& cost) {
  Json out;
  out["points"] = Json::of(cost.points);
  out["steps"] = Json::of(cost.steps);
  out["steps_cut_by_frames"] = Json::of(cost.cut_steps);
  out["frames"] = Json::of(cost.frames);
  out["results_bytes"] = Json::of(cost.results);
  out["memory_bytes"] = Json::of(cost.memory);
  out["core_seconds"] = Json::of(cost.seconds());
  out["setup_seconds"] = Json::of(cost.setup);
  out["writing_seconds"] = Json::of(cost.writing);
  return out;
}

Json elements_json(const Simulation& sim) {
  const MeshHealth& mesh = sim.elements();
  Json out;
  out["count"] = Json::of(mesh.elements);
  out["least_corner_jacobian"] = Json::of(mesh.least_corner);
  if (mesh.worst_body < 0) return out;
  out["worst_body"] = Json::of(sim.bodies()[static_cast<std::size_t>(mesh.worst_body)]->name());
  out["worst_element"] = Json::of(mesh.worst_element);
  return out;
}

}  // namespace

Json check_json(const Checked& of) {
  const Scene& scene = of.scene;
  const EffectReport report = report_effects(scene, EffectCosts{scene, of.sim.isa_level()}, "");
  Json out, step, bodies = Json::array();
  for (std::size_t b = 0; b < of.sim.bodies().size(); ++b)
    bodies.items.push_back(body_json(of, static_cast<int>(b)));
  step["stable"] = Json::of(of.sim.stable_step() / of.coarser);
  step["limit"] = Json::of(of.sim.describe_limit());
  out["title"] = Json::of(scene.title);
  out["frame"] = Json::of(std::string{name(scene.frame)});
  out["cell"] = Json::of(scene.grid.cell);
  out["cells_looked_at"] = Json::of(of.coarser);
  out["bodies"] = bodies;
  if (!scene.grid.refine.empty()) out["levels"] = levels_json(of.sim, of.coarser);
  if (of.sim.mesh() != nullptr) out["elements"] = elements_json(of.sim);
  out["time_step"] = step;
  out["contact"] = contact_json(scene);
  out["forecast"] = forecast_json(of.cost);
  out["effects"] = effects_json(scene, report);
  out["advice"] = texts(report.sentences);
  std::vector<std::string> notes = scene.notes;
  for (const std::string& note : card_notes(scene)) notes.push_back(note);
  out["notes"] = texts(notes);
  std::vector<std::string> doubts = doubts_of(scene);
  for (const auto& some : {doubt_levels(of.sim), doubt_course(of.sim)})
    doubts.insert(doubts.end(), some.begin(), some.end());
  out["doubts"] = texts(doubts);
  return out;
}

}  // namespace krater
