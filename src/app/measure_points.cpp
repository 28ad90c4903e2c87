// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "krater/app/measures.hpp"
#include "krater/app/snapshot.hpp"

namespace krater {

namespace {

MeasureContext make_context(const Scene& scene, const GridGeometry& geometry) {
  MeasureContext c;
  c.frame = scene.frame;
  c.h = scene.grid.cell;
  c.min = scene.grid.min;
  for (int a = 0; a < geometry.dimension; ++a)
    c.max[static_cast<std::size_t>(a)] = geometry.upper(a);
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t s = 0; s < 2; ++s) c.boundary[a][s] = scene.grid.boundary[a][s].kind;
  return c;
}

BodyPoints gather_points(const Simulation& sim, int index) {
  const Body& body = *sim.bodies()[static_cast<std::size_t>(index)];
  const int x = body.slot(field::Position::info), v = body.slot(field::Velocity::info);
  const int m = body.slot(field::Mass::info), rho = body.slot(field::Density::info);
  BodyPoints out;
  for (const auto& [patch, i] : sim.points_by_id(index)) {
    Triple position{}, velocity{};
    for (int a = 0; a < sim.geometry().dimension; ++a) {
      position[static_cast<std::size_t>(a)] = sim.value(patch, i, x + a);
      velocity[static_cast<std::size_t>(a)] = sim.value(patch, i, v + a);
    }
    out.x.push_back(position);
    out.v.push_back(velocity);
    out.mass.push_back(sim.value(patch, i, m));
    out.density.push_back(sim.value(patch, i, rho));
    for (const Column& c : body.layout().columns())
      if (c.components == 1)
        out.scalars[c.field->name].push_back(sim.value(patch, i, c.offset / kLanes));
  }
  return out;
}

}  // namespace

std::string measure_unit(const MeasureOptions& m) {
  if (m.kind == MeasureKind::mean_velocity) return "m/s";
  if (m.kind == MeasureKind::mean || m.kind == MeasureKind::maximum) return "SI";
  return "m";
}

std::vector<double> evaluate_measures(const Simulation& sim) {
  MeasureContext context = make_context(sim.scene(), sim.geometry());
  std::map<int, BodyPoints> points;  // gathered once per body
  std::vector<double> out;
  for (const MeasureOptions& m : sim.scene().measures) {
    if (!points.contains(m.body)) points[m.body] = gather_points(sim, m.body);
    // The widest spacing of the body: a surface is told to that.
    const auto& per = sim.scene().bodies[static_cast<std::size_t>(m.body)].points.per_direction;
    context.points_per_direction =
        *std::min_element(per.begin(), per.begin() + sim.geometry().dimension);
    out.push_back(evaluate(m, points.at(m.body), context));
  }
  return out;
}

Json measures_json(const Simulation& sim, const std::vector<double>& values) {
  static const std::map<MeasureKind, const char*> kinds{
      {MeasureKind::extent, "extent"},  {MeasureKind::max, "max"},
      {MeasureKind::min, "min"},        {MeasureKind::diameter, "diameter"},
      {MeasureKind::mean, "mean"},      {MeasureKind::mean_velocity, "mean_velocity"},
      {MeasureKind::maximum, "maximum"}};
  const Scene& scene = sim.scene();
  Json out;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const MeasureOptions& m = scene.measures[i];
    Json& j = out[m.name];
    j["value"] = Json::of(values[i]);
    j["unit"] = Json::of(measure_unit(m));
    j["kind"] = Json::of(kinds.at(m.kind));
    j["body"] = Json::of(scene.bodies[static_cast<std::size_t>(m.body)].name);
    if (m.axis >= 0) j["axis"] = Json::of(std::string{axis_name(scene.frame, m.axis)});
    if (m.kind == MeasureKind::diameter) j["at"] = Json::of(m.at);
    if (!m.reference) continue;
    j["reference"]["value"] = Json::of(*m.reference);
    j["reference"]["source"] = Json::of(m.reference_source);
    j["difference_percent"] = Json::of(100 * (values[i] - *m.reference) / *m.reference);
  }
  return out;
}

}  // namespace krater
