// SPDX-License-Identifier: GPL-3.0-or-later
// The points that the measures of a scene look at, with what they look at of them.
#include "measure/selections.hpp"

#include "measure/point_layers.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace krater {

namespace {

std::vector<std::string> fields_of(const MeasureOptions& measure) {
  switch (measure.kind) {
    case MeasureKind::mean:
    case MeasureKind::maximum:
    case MeasureKind::minimum:
      return {measure.field};
    case MeasureKind::internal_energy:
      return {"internal_energy"};
    case MeasureKind::failed_mass:
    case MeasureKind::mass_lost:
    case MeasureKind::sound_mass:
      return {"failed"};
    default:
      return {};
  }
}

bool needs_velocity(MeasureKind kind) {
  switch (kind) {
    case MeasureKind::mean_velocity:
    case MeasureKind::momentum:
    case MeasureKind::deceleration:
    case MeasureKind::settling_time:
    case MeasureKind::kinetic_energy:
    case MeasureKind::angular_momentum:
    case MeasureKind::obliquity:
    case MeasureKind::yaw:
      return true;
    default:
      return false;
  }
}

bool needs_surface(MeasureKind kind) {
  switch (kind) {
    case MeasureKind::extent:
    case MeasureKind::max:
    case MeasureKind::min:
    case MeasureKind::diameter:
    case MeasureKind::largest_diameter:
    case MeasureKind::penetration_depth:
    case MeasureKind::crater_depth:
    case MeasureKind::crater_diameter:
    case MeasureKind::hole_diameter:
    case MeasureKind::debris_extent:
    case MeasureKind::bulge:
      return true;
    default:
      return false;
  }
}

/// Some measure of these bodies does: all of them see the same points.
bool needs_surface(const Scene& scene, const std::vector<int>& bodies) {
  return std::any_of(scene.measures.begin(), scene.measures.end(), [&](const MeasureOptions& m) {
    return m.selection.bodies == bodies && needs_surface(m.kind);
  });
}

bool needs_pieces(const MeasureOptions& measure) {
  return measure.kind == MeasureKind::fragments || measure.selection.largest_piece ||
         measure.selection.least_points > 1;
}

void add_needs(const MeasureOptions& measure, GatherNeeds& needs) {
  for (const std::string& field : fields_of(measure)) needs.fields.push_back(field);
  needs.velocity = needs.velocity || needs_velocity(measure.kind);
  needs.pieces = needs.pieces || needs_pieces(measure);
}

}  // namespace

MeasureContext cells_of(const Simulation& sim, const std::vector<int>& bodies) {
  return measure_context(sim, bodies, needs_surface(sim.scene(), bodies));
}

bool in_row(const MeasureOptions& measure) {
  return measure.in_history || measure.keep != Keep::now || looks_back(measure.kind);
}

struct Selections::Kept {
  MeasureSelection selection{};
  BodyPoints points{};
  bool now = false;  ///< selected since the beginning
  PointLayers layers{};
};

Selections::~Selections() = default;

Selections::Selections(const Scene& scene) {
  for (const MeasureOptions& m : scene.measures) {
    const std::vector<int>& bodies = m.selection.bodies;
    needs_[bodies].surface = in_rows_[bodies].surface = needs_surface(scene, bodies);
    add_needs(m, needs_[bodies]);
    if (!in_row(m)) continue;
    add_needs(m, in_rows_[bodies]);
    bool& layers = layers_.try_emplace(bodies, true).first->second;
    layers = layers && looks_at_layers(m);
  }
}

void Selections::begin(Asked asked, const std::vector<PointSurvey>* survey) {
  asked_ = asked;
  survey_ = survey;
  for (Kept& kept : kept_) kept.now = false;
}

/// Of these bodies the rows ask for nothing else.
bool Selections::gathers_layers(const Simulation& sim, const MeasureSelection& selection) const {
  const auto found = layers_.find(selection.bodies);
  return survey_ != nullptr && found != layers_.end() && found->second &&
         PointLayers::should_gather(sim, selection.bodies);
}

const BodyPoints& Selections::points(const Simulation& sim, const MeasureSelection& selection) {
  auto at = std::find_if(kept_.begin(), kept_.end(),
                         [&](const Kept& kept) { return kept.selection == selection; });
  Kept& kept = at != kept_.end() ? *at : kept_.emplace_back();
  if (kept.now) return kept.points;
  kept.selection = selection;
  MeasureSelection whole;
  whole.bodies = selection.bodies;
  kept.points.memo = std::make_shared<SurfaceMemo>();
  if (gathers_layers(sim, selection)) {
    kept.layers.begin(sim, selection.bodies, *survey_);
    kept.points.memo->source = &kept.layers;
    kept.points.memo->bounds = kept.layers.bounds(cells_of(sim, selection.bodies));
  } else if (selection == whole) {
    kept.layers.release();  // at the end of a run the memory would count twice
    gather_points(sim, selection.bodies,
                  (asked_ == Asked::rows ? in_rows_ : needs_)[selection.bodies], kept.points);
  } else {
    kept.points = select(selection, points(sim, whole), cells_of(sim, selection.bodies));
    kept.points.memo = std::make_shared<SurfaceMemo>();
  }
  kept.now = true;
  return kept.points;
}

}  // namespace krater
