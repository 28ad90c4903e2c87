// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/measure/snapshot.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace krater {

namespace {

void add(std::vector<Quantity>& row, std::string name, std::string unit, double value) {
  row.push_back({std::move(name), std::move(unit), value});
}

void add_elements(const Simulation& sim, std::vector<Quantity>& row) {
  add(row, "hourglass_energy", "J", sim.elements().hourglass);
  add(row, "folded_elements", "1", static_cast<double>(sim.elements().folded));
  add(row, "eroded_elements", "1", sim.mesh()->eroded().all());
  add(row, "converted_elements", "1", sim.mesh()->converted().all());
}

void add_causes(Json& j, const std::string& what, const Eroded& eroded) {
  j[what + "_elements"] = Json::of(static_cast<std::int64_t>(eroded.all()));
  if (!(eroded.all() > 0)) return;
  Json& causes = j[what + "_by"];
  for (std::size_t k = 0; k < Eroded::parts.size(); ++k)
    causes[Eroded::names[k]] = Json::of(static_cast<std::int64_t>(eroded.*Eroded::parts[k]));
}

void add_elements(const Simulation& sim, Json& j) {
  const MeshHealth& mesh = sim.elements();
  j["hourglass_energy"] = Json::of(mesh.hourglass);
  j["hourglass_share"] = Json::of(mesh.hourglass_share());
  j["folded_elements"] = Json::of(static_cast<std::int64_t>(mesh.folded));
  j["most_folded_elements"] = Json::of(static_cast<std::int64_t>(sim.audit().most_folded));
  j["least_corner_jacobian"] = Json::of(mesh.least_corner);
  add_causes(j, "eroded", sim.mesh()->eroded());
  add_causes(j, "converted", sim.mesh()->converted());
  if (sim.mesh()->converted().all() > 0)
    j["conversion_heat"] = Json::of(sim.audit().conversion_heat);
}

void add_particles(const Simulation& sim, std::vector<Quantity>& row) {
  if (sim.sph() == nullptr) return;
  add(row, "uncorrected_particles", "1", static_cast<double>(sim.sph()->flat_count()));
  add(row, "stabilisation_heat", "J", sim.audit().stabilisation);
}

void add_particles(const Simulation& sim, Json& j) {
  if (sim.sph() == nullptr) return;
  j["uncorrected_particles"] = Json::of(static_cast<std::int64_t>(sim.sph()->flat_count()));
  j["stabilisation_heat"] = Json::of(sim.audit().stabilisation);
}

void add_torn_points(const Simulation& sim, std::vector<Quantity>& row) {
  if (sim.scene().method.numerical_fracture == NumericalFracture::ignore) return;
  const TornPoints& points = sim.torn_points();
  add(row, "stretched_points", "1", static_cast<double>(points.stretched));
  add(row, "torn_points", "1", static_cast<double>(points.torn));
  add(row, "torn_mass", "kg", points.torn_mass);
  add(row, "greatest_stretch", "1", points.greatest_stretch);
}

void add_torn_points(const Simulation& sim, Json& j) {
  if (sim.scene().method.numerical_fracture == NumericalFracture::ignore) return;
  const TornPoints& points = sim.torn_points();
  Json& out = j["numerical_fracture"];
  out["stretched_points"] = Json::of(static_cast<std::int64_t>(points.stretched));
  out["torn_points"] = Json::of(static_cast<std::int64_t>(points.torn));
  out["torn_mass"] = Json::of(points.torn_mass);
  out["greatest_stretch"] = Json::of(points.greatest_stretch);
  for (std::size_t b = 0; b < points.torn_by_body.size(); ++b)
    out["torn_points_of"][sim.bodies()[b]->name()] =
        Json::of(static_cast<std::int64_t>(points.torn_by_body[b]));
}

/// Points of the blocks of a level.
std::size_t points_at(const Simulation& sim, int level) {
  std::size_t count = 0;
  for (const Patch& patch : sim.grid().patches())
    if (patch.key.level == level) count += static_cast<std::size_t>(patch.count());
  return count;
}

void add_levels(const Simulation& sim, std::vector<Quantity>& row) {
  if (sim.scene().grid.refine.empty()) return;
  for (int level = 0; level <= sim.scene().grid.finest(); ++level)
    add(row, "points_level_" + std::to_string(level), "1",
        static_cast<double>(points_at(sim, level)));
}

void add_levels(const Simulation& sim, Json& j) {
  if (sim.scene().grid.refine.empty()) return;
  Json& counts = j["points_by_level"];
  for (int level = 0; level <= sim.scene().grid.finest(); ++level)
    counts[std::to_string(level)] = Json::of(static_cast<std::int64_t>(points_at(sim, level)));
}

/// Points that are made and taken away while the scene runs.
void add_made_points(const Simulation& sim, std::vector<Quantity>& row) {
  if (sim.makes_points()) add(row, "level_heat", "J", sim.audit().level_heat);
}

void add_made_points(const Simulation& sim, Json& j) {
  if (!sim.makes_points()) return;
  j["split_points"] = Json::of(static_cast<std::int64_t>(sim.audit().split_points));
  j["merged_points"] = Json::of(static_cast<std::int64_t>(sim.audit().merged_points));
  j["level_heat"] = Json::of(sim.audit().level_heat);
}

void add_points(const Simulation& sim, std::vector<Quantity>& row) {
  add_levels(sim, row);
  add_made_points(sim, row);
  add_torn_points(sim, row);
}

}  // namespace

std::vector<Quantity> history_row(const Simulation& sim, const std::vector<PointSurvey>& survey) {
  const Audit& a = sim.audit();
  const std::vector<Totals> bodies = sim.totals_by_body(survey);
  Totals t;
  for (const Totals& body : bodies) t += body;
  std::vector<Quantity> row;
  add(row, "time", "s", sim.time());
  add(row, "step", "1", static_cast<double>(sim.steps()));
  add(row, "dt", "s", sim.dt());
  add(row, "dt_limiter", "1", sim.limiter_kind());
  add(row, "kinetic_energy", "J", t.kinetic);
  add(row, "internal_energy", "J", t.internal);
  add(row, "total_energy", "J", t.kinetic + t.internal);
  add(row, "deviatoric_elastic_energy", "J", t.deviatoric);
  add(row, "plastic_work", "J", a.plastic_work);
  add(row, "viscous_work", "J", a.viscous_work);
  add(row, "transfer_loss", "J", a.transfer_loss);
  add(row, "transfer_gain", "J", a.transfer_gain);
  add(row, "numerical_heat", "J", a.numerical_heat);
  add(row, "carried_energy", "J", a.carried);
  add(row, "wall_heat", "J", a.wall_heat);
  add(row, "wall_work", "J", a.wall_work);
  add(row, "contact_heat", "J", a.contact_heat);
  add(row, "friction_work", "J", a.friction_work);
  add(row, "external_work", "J", a.external_work);
  add(row, "removed_energy", "J", a.removed_energy);
  add(row, "energy_residual", "J", a.residual(t.kinetic, t.internal));
  add(row, "energy_error_fraction", "1", a.error_fraction());
  if (sim.mesh() != nullptr) add_elements(sim, row);
  add_particles(sim, row);
  add_points(sim, row);
  add(row, "mass", "kg", t.mass);
  const Frame frame = sim.scene().frame;
  for (int k = 0; k < dimension(frame); ++k)
    add(row, "momentum_" + std::string{axis_name(frame, k)}, "kg m/s",
        t.momentum[static_cast<std::size_t>(k)]);
  for (int k = 0; k < dimension(frame); ++k)
    add(row, "wall_impulse_" + std::string{axis_name(frame, k)}, "N s",
        a.wall_impulse[static_cast<std::size_t>(k)]);
  for (int k = 0; k < dimension(frame); ++k)
    add(row, "external_impulse_" + std::string{axis_name(frame, k)}, "N s",
        a.external_impulse[static_cast<std::size_t>(k)]);
  add(row, "angular_momentum", "kg m^2/s", t.angular_momentum);
  add(row, "removed_points", "1", a.removed_points);
  add(row, "removed_mass", "kg", a.removed_mass);
  add(row, "wall_columns", "1", a.wall_columns);
  add(row, "contact_pairs", "1", a.contact_pairs);
  for (std::size_t b = 0; b < sim.bodies().size(); ++b) {
    const Totals& body = bodies[b];
    add(row, sim.bodies()[b]->name() + ".kinetic_energy", "J", body.kinetic);
    for (int k = 0; k < dimension(frame); ++k)
      add(row, sim.bodies()[b]->name() + ".mean_velocity_" + std::string{axis_name(frame, k)},
          "m/s", body.mass > 0 ? body.momentum[static_cast<std::size_t>(k)] / body.mass : 0.0);
    const RigidBody* rigid = sim.rigid().find(static_cast<int>(b));
    for (int k = 0; rigid && k < dimension(frame); ++k)
      add(row, sim.bodies()[b]->name() + ".contact_impulse_" + std::string{axis_name(frame, k)},
          "N s", rigid->received()[k]);
  }
  return row;
}

namespace {

Json events_json(const Audit& a) {
  Json events;
  events["removed_points"] = Json::of(static_cast<std::int64_t>(a.removed_points));
  events["removed_failed_points"] = Json::of(static_cast<std::int64_t>(a.removed_failed));
  events["sound_speed_floors"] = Json::of(static_cast<std::int64_t>(a.sound_speed_floors));
  events["hugoniot_poles"] = Json::of(static_cast<std::int64_t>(a.hugoniot_poles));
  events["failures"] = Json::of(static_cast<std::int64_t>(a.failures));
  events["snap_backs"] = Json::of(static_cast<std::int64_t>(a.snap_backs));
  events["spalls"] = Json::of(static_cast<std::int64_t>(a.spalls));
  events["new_references"] = Json::of(static_cast<std::int64_t>(a.new_references));
  events["carriers"] = Json::of(static_cast<std::int64_t>(a.carriers));
  events["reflections"] = Json::of(static_cast<std::int64_t>(a.reflections));
  events["penetrations"] = Json::of(static_cast<std::int64_t>(a.penetrations));
  events["deepest_reflection_cells"] = Json::of(a.deepest_reflection);
  events["halved_steps"] = Json::of(static_cast<std::int64_t>(a.retries));
  return events;
}

}  // namespace

Json audit_json(const Simulation& sim) {
  const Audit& a = sim.audit();
  const Totals t = sim.totals();
  Json j;
  const double start = a.initial_kinetic + a.initial_internal,
               residual = a.residual(t.kinetic, t.internal);
  j["initial_energy"] = Json::of(start);
  j["kinetic_energy"] = Json::of(t.kinetic);
  j["internal_energy"] = Json::of(t.internal);
  j["plastic_work"] = Json::of(a.plastic_work);
  j["viscous_work"] = Json::of(a.viscous_work);
  j["external_work"] = Json::of(a.external_work);
  j["load_work"] = Json::of(a.load_work);
  j["damping_work"] = Json::of(a.damping_work);
  j["wall_work"] = Json::of(a.wall_work);
  j["wall_heat"] = Json::of(a.wall_heat);
  j["contact_heat"] = Json::of(a.contact_heat);
  j["friction_work"] = Json::of(a.friction_work);
  j["transfer_loss"] = Json::of(a.transfer_loss);
  j["transfer_gain"] = Json::of(a.transfer_gain);
  j["numerical_heat"] = Json::of(a.numerical_heat);
  j["carried_energy"] = Json::of(a.carried);
  j["largest_carried_energy"] = Json::of(a.largest_carried);
  if (sim.mesh() != nullptr) add_elements(sim, j);
  add_particles(sim, j);
  add_levels(sim, j);
  add_made_points(sim, j);
  add_torn_points(sim, j);
  j["removed_energy"] = Json::of(a.removed_energy);
  j["energy_residual"] = Json::of(residual);
  j["energy_residual_fraction"] = Json::of(start > 0 ? residual / start : residual);
  j["energy_error_fraction"] = Json::of(a.error_fraction());
  j["mass"] = Json::of(t.mass);
  j["removed_mass"] = Json::of(a.removed_mass);
  const std::pair<const char*, const Triple&> momenta[] = {
      {"momentum_", t.momentum},
      {"wall_impulse_", a.wall_impulse},
      {"external_impulse_", a.external_impulse},
      {"load_impulse_", a.load_impulse},
      {"damping_impulse_", a.damping_impulse},
      {"removed_momentum_", a.removed_momentum}};
  for (const auto& [name, value] : momenta)
    for (int k = 0; k < dimension(sim.scene().frame); ++k)
      j[name + std::string{axis_name(sim.scene().frame, k)}] =
          Json::of(value[static_cast<std::size_t>(k)]);
  j["angular_momentum"] = Json::of(t.angular_momentum);
  j["events"] = events_json(a);
  return j;
}

}  // namespace krater
