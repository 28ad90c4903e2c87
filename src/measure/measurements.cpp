// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/measure/measurements.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <sstream>
#include <utility>

#include "krater/core/errors.hpp"
#include "krater/measure/measure_surface.hpp"
#include "krater/measure/pieces.hpp"
#include "krater/measure/snapshot.hpp"
#include "measure/selections.hpp"

namespace krater {

namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

bool needs_face(const MeasureOptions& measure) { return measure.side >= 0; }

bool needs_mass(const MeasureOptions& measure) {
  return measure.kind == MeasureKind::removed_mass || measure.kind == MeasureKind::mass_lost;
}

/// By grid axis.
Json vector_json(Frame frame, const Triple& v) {
  Json out;
  for (int a = 0; a < dimension(frame); ++a)
    out[std::string{axis_name(frame, a)}] = Json::of(v[static_cast<std::size_t>(a)]);
  return out;
}

Json piece_json(const Piece& piece, const Scene& scene) {
  const auto& per = scene.bodies[static_cast<std::size_t>(piece.body)].points.per_direction;
  Triple size{};
  for (std::size_t a = 0; a < 3; ++a)
    size[a] = piece.high[a] - piece.low[a] + scene.grid.cell / per[a];
  Json j;
  j["body"] = Json::of(scene.bodies[static_cast<std::size_t>(piece.body)].name);
  j["number"] = Json::of(piece.number);
  j["mass"] = Json::of(piece.mass);
  j["points"] = Json::of(piece.points);
  j["velocity"] = vector_json(scene.frame, piece.velocity);
  j["centre"] = vector_json(scene.frame, piece.centre);
  j["size"] = vector_json(scene.frame, size);
  return j;
}

/// Pieces of at least `least_points` one by one; the rest, too small to be resolved, as a whole.
Json fragments_json(const MeasureOptions& measure, const BodyPoints& points,
                    const MeasureContext& context, const Scene& scene) {
  Json j, list = Json::array();
  std::size_t pieces = 0, count = 0;
  double mass = 0;
  for (const Piece& piece : connected_pieces(points, context).list) {
    if (piece.points >= static_cast<std::size_t>(measure.selection.least_points)) {
      list.items.push_back(piece_json(piece, scene));
      continue;
    }
    pieces += 1;
    count += piece.points;
    mass += piece.mass;
  }
  j["least_points"] = Json::of(measure.selection.least_points);
  j["pieces"] = std::move(list);
  j["dust"]["pieces"] = Json::of(pieces);
  j["dust"]["points"] = Json::of(count);
  j["dust"]["mass"] = Json::of(mass);
  return j;
}

Json bodies_json(const Scene& scene, const std::vector<int>& bodies) {
  if (bodies.size() == 1)
    return Json::of(scene.bodies[static_cast<std::size_t>(bodies.front())].name);
  Json names = Json::array();
  for (const int b : bodies)
    names.items.push_back(Json::of(scene.bodies[static_cast<std::size_t>(b)].name));
  return names;
}

std::string partner_name(const Scene& scene, Partner by) {
  if (by.kind == Partner::Kind::body) return scene.bodies[static_cast<std::size_t>(by.number)].name;
  return std::string{axis_name(scene.frame, by.number / 2)} +
         (by.number % 2 == 0 ? "_min" : "_max");
}

Json measure_json(const MeasureOptions& m, const Scene& scene, const MeasureStart& start,
                  const MeasureSeries& series, double value) {
  Json j;
  j["value"] = Json::of(value);
  j["unit"] = Json::of(unit_of(m));
  j["kind"] = Json::of(info(m.kind).name);
  j["body"] = bodies_json(scene, m.selection.bodies);
  if (m.by.size() == 1) j["by"] = Json::of(partner_name(scene, m.by.front()));
  if (m.direction != Triple{}) j["direction"] = vector_json(scene.frame, m.direction);
  if (m.axis >= 0) j["axis"] = Json::of(std::string{axis_name(scene.frame, m.axis)});
  if (m.kind == MeasureKind::diameter) j["at"] = Json::of(m.at);
  if (m.kind == MeasureKind::largest_diameter && m.level > 0) j["within"] = Json::of(m.level);
  if (!m.field.empty()) j["field"] = Json::of(m.field);
  if (m.kind == MeasureKind::maximum || m.kind == MeasureKind::minimum)
    j["mass_share"] = Json::of(m.mass_share);
  if (needs_face(m)) j["face"] = Json::of(start.face);
  if (m.selection.largest_piece) j["piece"] = Json::of("largest");
  if (m.keep != Keep::now) {
    j["keep"] = Json::of(m.keep == Keep::largest ? "largest" : "smallest");
    j["time"] = Json::of(series.kept_time);
  }
  if (!m.reference) return j;
  j["reference"]["value"] = Json::of(*m.reference);
  if (m.reference_error) j["reference"]["error"] = Json::of(*m.reference_error);
  j["reference"]["source"] = Json::of(m.reference_source);
  j["difference_percent"] = Json::of(100 * (value - *m.reference) / *m.reference);
  return j;
}

/// What each of all partners gave along the measure's direction so far [N s].
Json impulses_json(const MeasureOptions& m, const Simulation& sim) {
  const Triple n = direction_of(m);
  Json j;
  for (const Partner by : m.by) {
    const Triple J = sim.impulse(m.selection.bodies, by);
    j[partner_name(sim.scene(), by)] = Json::of(J[0] * n[0] + J[1] * n[1] + J[2] * n[2]);
  }
  return j;
}

}  // namespace

MeasureContext context_of(const Simulation& sim, const MeasureOptions& measure) {
  MeasureContext out = cells_of(sim, measure.selection.bodies);
  for (const Partner by : measure.by) {
    const Triple more = sim.impulse(measure.selection.bodies, by);
    for (std::size_t a = 0; a < 3; ++a) out.impulse[a] += more[a];
  }
  return out;
}

bool looks_at_points(const Scene& scene) {
  return scene.method.numerical_fracture != NumericalFracture::ignore ||
         std::any_of(scene.measures.begin(), scene.measures.end(), [](const MeasureOptions& m) {
           return m.kind != MeasureKind::impulse && m.kind != MeasureKind::force;
         });
}

bool looks_on_its_own(const Scene& scene) {
  return !scene.outcomes.empty() || !scene.gauges.empty();
}

bool draws_all_points(const Scene& scene) {
  const std::vector<std::string>& fields = scene.output.fields;
  return scene.method.numerical_fracture != NumericalFracture::ignore ||
         std::find(fields.begin(), fields.end(), kFragmentField) != fields.end();
}

Measurements::Measurements(const Simulation& sim) : selections_{sim.scene()} {
  Selections selections{sim.scene()};  // of the start only: they do not stay
  for (const MeasureOptions& m : sim.scene().measures) {
    MeasureStart start;
    if (needs_mass(m))
      for (const double mass : selections.points(sim, m.selection).mass) start.mass += mass;
    if (needs_face(m)) {
      MeasureSelection owner = m.selection;
      if (m.target >= 0) {
        owner = {};
        owner.bodies = {m.target};
      }
      start.face = face_position(m, selections.points(sim, owner), cells_of(sim, owner.bodies));
    }
    start_.push_back(start);
  }
  series_.resize(start_.size());
}

void Measurements::check(const Simulation& sim) const {
  const std::vector<Quantity> columns = history_row(sim, {});
  for (const MeasureOptions& m : sim.scene().measures)
    for (const Quantity& column : columns)
      if (m.in_history && column.name == m.name)
        throw InputError(
            m.where + ": the history has a column of this name; call the measure " +
            sim.scene().bodies.at(static_cast<std::size_t>(m.selection.bodies.at(0))).name + "_" +
            m.name + ", or say history: false");
  Selections selections{sim.scene()};
  for (std::size_t i = 0; i < start_.size(); ++i) {
    const MeasureOptions& m = sim.scene().measures[i];
    evaluate(m, selections.points(sim, m.selection), context_of(sim, m), start_[i]);
  }
}

double Measurements::sample(const Simulation& sim, std::size_t i) {
  const MeasureOptions& m = sim.scene().measures[i];
  return evaluate(m, selections_.points(sim, m.selection), context_of(sim, m), start_[i]);
}

std::vector<double> Measurements::now(const Simulation& sim, const std::vector<int>& measures) {
  selections_.begin(Selections::Asked::all);
  std::vector<double> out;
  for (const int i : measures) out.push_back(sample(sim, static_cast<std::size_t>(i)));
  return out;
}

/// None of a broken state: its positions may be anything.
std::vector<double> Measurements::values(const Simulation& sim,
                                         const std::vector<PointSurvey>* survey) {
  std::vector<double> out(start_.size(), kNothing);
  if (sim.broken()) return out;
  const bool all = survey == nullptr;
  selections_.begin(all ? Selections::Asked::all : Selections::Asked::rows, survey);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const MeasureOptions& m = sim.scene().measures[i];
    if (!all && !in_row(m)) continue;
    out[i] = follow(m, series_[i], sim.time(), sample(sim, i));
  }
  return out;
}

std::vector<Quantity> Measurements::titles(const Scene& scene) const {
  std::vector<Quantity> columns;
  for (const MeasureOptions& m : scene.measures)
    if (m.in_history) columns.push_back({m.name, unit_of(m), kNothing});
  return columns;
}

std::vector<Quantity> Measurements::row(const Simulation& sim,
                                        const std::vector<PointSurvey>& survey) {
  const std::vector<double> now = values(sim, &survey);
  std::vector<Quantity> columns = titles(sim.scene());
  std::size_t column = 0;
  for (std::size_t i = 0; i < now.size(); ++i)
    if (sim.scene().measures[i].in_history) columns[column++].value = now[i];
  return columns;
}

void Measurements::summarize(const Simulation& sim, Json& summary) {
  const Scene& scene = sim.scene();
  const std::vector<double> now = values(sim, nullptr);
  Json measures, fragments;
  nothing_.clear();
  for (std::size_t i = 0; i < now.size(); ++i) {
    const MeasureOptions& m = scene.measures[i];
    Json& measure = measures[m.name] = measure_json(m, scene, start_[i], series_[i], now[i]);
    if (m.by.size() > 1) {
      measure["by"] = Json::of("all");
      measure["impulses"] = impulses_json(m, sim);
    }
    if (!sim.broken() &&
        rarefied(m, selections_.points(sim, m.selection), cells_of(sim, m.selection.bodies)))
      measure["rarefied"] = Json::of(true);
    if (std::isnan(now[i]) && !sim.broken() && selections_.points(sim, m.selection).mass.empty())
      nothing_.push_back(m.name);
    if (m.kind != MeasureKind::fragments || sim.broken()) continue;
    MeasureSelection with_dust = m.selection;
    with_dust.least_points = 0;
    fragments[m.name] = fragments_json(m, selections_.points(sim, with_dust),
                                       cells_of(sim, m.selection.bodies), scene);
  }
  summary["measures"] = std::move(measures);
  if (!fragments.items.empty()) summary["fragments"] = std::move(fragments);
}

void Measurements::save(Checkpoint& checkpoint, const Scene& scene) const {
  std::string names;
  for (std::size_t i = 0; i < series_.size(); ++i) {
    const MeasureSeries& s = series_[i];
    std::vector<double> x{s.kept, s.kept_time};
    x.insert(x.end(), s.time.begin(), s.time.end());
    x.insert(x.end(), s.sample.begin(), s.sample.end());
    checkpoint.blobs.push_back({"measures/" + std::to_string(i), {x.size()}, std::move(x), {}, {}});
    names += scene.measures[i].name + "\n";
  }
  if (!names.empty()) checkpoint.blobs.push_back({"measures/names", {}, {}, {}, std::move(names)});
}

void Measurements::restore(const Checkpoint& checkpoint, const Scene& scene,
                           const std::vector<std::string>& changed) {
  const CheckpointBlob* names = checkpoint.find("measures/names");
  if (names == nullptr) return;
  std::istringstream lines{names->text};
  std::string name;
  for (std::size_t number = 0; std::getline(lines, name); ++number) {
    const CheckpointBlob* blob = checkpoint.find("measures/" + std::to_string(number));
    const auto at = std::find_if(scene.measures.begin(), scene.measures.end(),
                                 [&name](const MeasureOptions& m) { return m.name == name; });
    const bool other = std::find(changed.begin(), changed.end(), name) != changed.end();
    if (at == scene.measures.end() || other || blob == nullptr || blob->doubles.size() < 2)
      continue;
    const std::vector<double>& x = blob->doubles;
    const auto half = static_cast<std::ptrdiff_t>((x.size() - 2) / 2);
    MeasureSeries& s = series_[static_cast<std::size_t>(at - scene.measures.begin())];
    s.kept = x[0];
    s.kept_time = x[1];
    s.time.assign(x.begin() + 2, x.begin() + 2 + half);
    s.sample.assign(x.begin() + 2 + half, x.end());
  }
}

}  // namespace krater
