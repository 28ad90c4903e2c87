// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/measure/gauges.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "krater/core/errors.hpp"
#include "krater/points/fields.hpp"

namespace krater {

namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

double projection(const Triple& a, const Triple& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

const Body& body_of(const Simulation& sim, const GaugeOptions& gauge) {
  return *sim.bodies()[static_cast<std::size_t>(gauge.body)];
}

template <class Call>
void for_points(const Simulation& sim, const GaugeOptions& gauge, const Call& call) {
  for (int s = 0; s < sim.set_count(); ++s)
    if (sim.set(s).body == gauge.body)
      for (int i = 0; i < sim.set(s).count(); ++i) call(s, i);
}

double distance(const Simulation& sim, int x, int s, int i, const Triple& at) {
  double square = 0;
  for (int a = 0; a < sim.geometry().dimension; ++a) {
    const double d = sim.value(s, i, x + a) - at[static_cast<std::size_t>(a)];
    square += d * d;
  }
  return std::sqrt(square);
}

/// prod (1 - |d_a|/h), as far as it is positive.
double hat(const Simulation& sim, int x, int s, int i, const Triple& at) {
  double w = 1;
  for (int a = 0; a < sim.geometry().dimension; ++a)
    w *= std::max(0.0, 1 - std::abs(sim.value(s, i, x + a) - at[static_cast<std::size_t>(a)]) *
                               sim.geometry().inv_h);
  return w;
}

}  // namespace

double Gauges::find_id(const Simulation& sim, const GaugeOptions& gauge, std::size_t place) const {
  const Body& body = body_of(sim, gauge);
  const int x = body.slot(field::Position::info), id = body.slot(field::Id::info);
  double nearest = std::numeric_limits<double>::infinity(), found = -1;
  for_points(sim, gauge, [&](int s, int i) {
    const double d = distance(sim, x, s, i, gauge.at[place]), number = sim.value(s, i, id);
    if (d > nearest || (d == nearest && number > found)) return;
    nearest = d;
    found = number;
  });
  if (nearest > sim.geometry().h)
    throw InputError(
        fmt::format("{}: its place {} lies outside {}, {:.3g} m from the nearest point",
                    gauge.where, place, body.name(), nearest));
  return found;
}

Gauges::Gauges(const Simulation& sim, Measurements& measurements)
    : scene_{sim.scene()}, measurements_{measurements} {
  for (std::size_t g = 0; g < scene_.gauges.size(); ++g) {
    const GaugeOptions& gauge = scene_.gauges[g];
    Record& record = records_.emplace_back();
    for (std::size_t f = 0; f < gauge.fields.size(); ++f)
      record.fields.push_back(gauge.body < 0
                                  ? measure_field(scene_, gauge.measures[f], gauge.fields[f])
                                  : find_gauge_field(sim, gauge, gauge.fields[f]));
    for (std::size_t k = 0; k < gauge.at.size() && !gauge.fixed; ++k)
      record.ids.push_back(find_id(sim, gauge, k));
    if (gauge.normal) place_sections(sim, g);
    const std::size_t places = std::max<std::size_t>(gauge.at.size(), 1);
    record.gone.assign(places, -1);
    record.values.resize(places * gauge.fields.size());
    sample(sim, g);
  }
}

void Gauges::sample_measures(const Simulation& sim, std::size_t g) {
  Record& record = records_[g];
  const std::vector<double> now = measurements_.now(sim, scene_.gauges[g].measures);
  for (std::size_t f = 0; f < now.size(); ++f) record.values[f].push_back(now[f]);
  const bool any = std::any_of(now.begin(), now.end(), [](double x) { return !std::isnan(x); });
  if (!any && record.gone[0] < 0) record.gone[0] = sim.time();
}

template <class Weight, class Value>
void Gauges::sample_body(const Simulation& sim, std::size_t g, const Weight& weight,
                         const Value& value) {
  Record& record = records_[g];
  const std::size_t fields = record.fields.size(), places = scene_.gauges[g].at.size();
  std::vector<double> sum(places * fields, 0.0), all(places, 0.0);
  for_points(sim, scene_.gauges[g], [&](int s, int i) {
    for (std::size_t k = 0; k < places; ++k) {
      const double w = weight(k, s, i);
      if (!(w > 0)) continue;
      all[k] += w;
      for (std::size_t f = 0; f < fields; ++f) sum[k * fields + f] += w * value(k, f, s, i);
    }
  });
  for (std::size_t k = 0; k < places; ++k) {
    if (!(all[k] > 0) && record.gone[k] < 0) record.gone[k] = sim.time();
    for (std::size_t f = 0; f < fields; ++f) {
      const double by = record.fields[f].is_sum() ? 1 : all[k];
      record.values[k * fields + f].push_back(all[k] > 0 ? sum[k * fields + f] / by : kNothing);
    }
  }
}

void Gauges::sample_points(const Simulation& sim, std::size_t g) {
  const GaugeOptions& gauge = scene_.gauges[g];
  const Record& record = records_[g];
  const Body& body = body_of(sim, gauge);
  const int x = body.slot(field::Position::info), m = body.slot(field::Mass::info),
            id = body.slot(field::Id::info);
  const auto weight = [&](std::size_t k, int s, int i) {
    if (gauge.fixed) return sim.value(s, i, m) * hat(sim, x, s, i, gauge.at[k]);
    return sim.value(s, i, id) == record.ids[k] ? 1.0 : 0.0;
  };
  sample_body(sim, g, weight, [&](std::size_t, std::size_t f, int s, int i) {
    return value_at(sim, record.fields[f], s, i);
  });
}

/// None where the material point that carries it is gone.
std::vector<std::optional<SectionPlane>> Gauges::planes(const Simulation& sim, std::size_t g,
                                                        const SectionReader& reader) const {
  const GaugeOptions& gauge = scene_.gauges[g];
  const Record& record = records_[g];
  std::vector<std::optional<SectionPlane>> out(gauge.at.size());
  for (std::size_t k = 0; k < out.size() && gauge.fixed; ++k)
    out[k] = SectionPlane{projection(*gauge.normal, gauge.at[k]), 0};
  if (gauge.fixed) return out;
  const int id = body_of(sim, gauge).slot(field::Id::info);
  for_points(sim, gauge, [&](int s, int i) {
    for (std::size_t k = 0; k < out.size(); ++k)
      if (sim.value(s, i, id) == record.ids[k]) {
        out[k] = reader.through(s, i);
        out[k]->at += record.offset[k];
      }
  });
  return out;
}

/// At the start: how far they are from their material points.
void Gauges::place_sections(const Simulation& sim, std::size_t g) {
  const GaugeOptions& gauge = scene_.gauges[g];
  records_[g].offset.assign(gauge.at.size(), 0.0);
  const auto plane = planes(sim, g, {sim, body_of(sim, gauge), *gauge.normal});
  for (std::size_t k = 0; k < gauge.at.size(); ++k)
    if (plane[k]) records_[g].offset[k] = projection(*gauge.normal, gauge.at[k]) - plane[k]->at;
}

void Gauges::sample_sections(const Simulation& sim, std::size_t g) {
  const Record& record = records_[g];
  const SectionReader reader{sim, body_of(sim, scene_.gauges[g]), *scene_.gauges[g].normal};
  const auto plane = planes(sim, g, reader);
  sample_body(
      sim, g,
      [&](std::size_t k, int s, int i) { return plane[k] ? reader.area(*plane[k], s, i) : 0.0; },
      [&](std::size_t k, std::size_t f, int s, int i) {
        return record.fields[f].is_sum() ? reader.value(*plane[k], record.fields[f], s, i)
                                         : value_at(sim, record.fields[f], s, i);
      });
}

void Gauges::sample(const Simulation& sim, std::size_t g) {
  const GaugeOptions& gauge = scene_.gauges[g];
  Record& record = records_[g];
  record.time.push_back(sim.time());
  record.next = (std::floor(sim.time() / gauge.every * (1 + 1e-12)) + 1) * gauge.every;
  if (gauge.body < 0)
    sample_measures(sim, g);
  else if (gauge.normal)
    sample_sections(sim, g);
  else
    sample_points(sim, g);
}

bool Gauges::due(double time) const {
  return std::any_of(records_.begin(), records_.end(),
                     [time](const Record& r) { return time >= r.next; });
}

void Gauges::look(const Simulation& sim) {
  for (std::size_t g = 0; g < records_.size(); ++g)
    if (sim.time() >= records_[g].next) sample(sim, g);
}

const std::string& Gauges::body_name(const GaugeOptions& gauge) const {
  return scene_.bodies[static_cast<std::size_t>(gauge.body)].name;
}

std::string Gauges::column_name(std::size_t g, std::size_t column) const {
  const GaugeOptions& gauge = scene_.gauges[g];
  const std::string& field = gauge.fields[column % gauge.fields.size()];
  return gauge.at.size() <= 1 ? field : fmt::format("{}_{}", field, column / gauge.fields.size());
}

/// All columns; with a filter at its own times, and filtered.
std::vector<TableColumn> Gauges::table(std::size_t g) const {
  const GaugeOptions& gauge = scene_.gauges[g];
  const Record& record = records_[g];
  const bool filters = gauge.filter != GaugeFilter::none;
  const std::string meaning =
      filters ? fmt::format("{}, -3 dB at {:.6g} Hz", gauge.filter_name, gauge.frequency) : "";
  std::vector<TableColumn> out{{"time", "s", "time", record.time}};
  if (filters) out[0].values = resampled(record.time, record.time, gauge.every);
  for (std::size_t c = 0; c < record.values.size(); ++c) {
    const GaugeField& field = record.fields[c % record.fields.size()];
    std::vector<double> values = changed(field, record.time, record.values[c]);
    if (filters) values = resampled(record.time, values, gauge.every);
    const char* what = gauge.body < 0 ? "as the measure has it" : "as the points have it";
    out.push_back({column_name(g, c), field.unit, what, values});
    if (filters)
      out.push_back({column_name(g, c) + "_filtered", field.unit, meaning,
                     filtered(values, gauge.every, gauge.filter, gauge.frequency)});
  }
  return out;
}

void Gauges::write(ResultsFolder& results) const {
  for (std::size_t g = 0; g < records_.size(); ++g) {
    const GaugeOptions& gauge = scene_.gauges[g];
    SeriesTable series{gauge.name, table(g), {}, {{"every", gauge.every}}};
    if (gauge.body >= 0) series.texts.emplace_back("body", body_name(gauge));
    if (gauge.filter != GaugeFilter::none) {
      series.texts.emplace_back("filter", gauge.filter_name);
      series.numbers.emplace_back("filter_frequency", gauge.frequency);
    }
    results.write_gauge(std::move(series));
  }
}

std::vector<std::string> Gauges::sentences() const {
  std::vector<std::string> out;
  for (std::size_t g = 0; g < records_.size(); ++g)
    for (std::size_t k = 0; k < records_[g].gone.size(); ++k)
      if (records_[g].gone[k] >= 0)
        out.push_back(fmt::format("note: gauge {}, place {}: nothing is there since {:.4g} s",
                                  scene_.gauges[g].name, k, records_[g].gone[k]));
  return out;
}

void Gauges::summarize(Json& summary) const {
  for (std::size_t g = 0; g < records_.size(); ++g) {
    const GaugeOptions& gauge = scene_.gauges[g];
    Json& j = summary["gauges"][gauge.name];
    j["file"] = Json::of("gauge_" + gauge.name + ".csv");
    if (gauge.body >= 0) j["body"] = Json::of(body_name(gauge));
    j["places"] = Json::of(records_[g].gone.size());
    j["samples"] = Json::of(records_[g].time.size());
    if (gauge.filter != GaugeFilter::none) {
      j["filter"] = Json::of(gauge.filter_name);
      j["filter_frequency"] = Json::of(gauge.frequency);
    }
    Json& gone = j["nothing_there_since"] = Json::array();
    for (const double t : records_[g].gone)
      gone.items.push_back(t < 0 ? Json::null() : Json::of(t));
  }
}

void Gauges::save(Checkpoint& checkpoint) const {
  for (std::size_t g = 0; g < records_.size(); ++g) {
    const Record& record = records_[g];
    const std::string name = "gauges/" + scene_.gauges[g].name;
    std::vector<double> x = record.time;
    for (const std::vector<double>& values : record.values)
      x.insert(x.end(), values.begin(), values.end());
    x.insert(x.end(), record.gone.begin(), record.gone.end());
    checkpoint.blobs.push_back({name + "/record", {x.size()}, std::move(x), {}, {}});
    std::string fields;
    for (const std::string& field : scene_.gauges[g].fields) fields += field + "\n";
    checkpoint.blobs.push_back({name + "/fields", {}, {}, {}, fields});
  }
}

void Gauges::restore(const Checkpoint& checkpoint) {
  for (std::size_t g = 0; g < records_.size(); ++g) {
    Record& record = records_[g];
    const std::string name = "gauges/" + scene_.gauges[g].name;
    const CheckpointBlob *blob = checkpoint.find(name + "/record"),
                         *known = checkpoint.find(name + "/fields");
    std::string fields;
    for (const std::string& field : scene_.gauges[g].fields) fields += field + "\n";
    const std::size_t places = record.gone.size(), columns = record.values.size() + 1;
    if (blob == nullptr || known == nullptr || known->text != fields ||
        blob->doubles.size() < places || (blob->doubles.size() - places) % columns != 0)
      continue;
    const auto rows = static_cast<std::ptrdiff_t>((blob->doubles.size() - places) / columns);
    auto from = blob->doubles.begin();
    record.time.assign(from, from + rows);
    for (std::vector<double>& values : record.values) {
      from += rows;
      values.assign(from, from + rows);
    }
    record.gone.assign(from + rows, blob->doubles.end());
    const double every = scene_.gauges[g].every;
    if (rows > 0) record.next = (std::floor(record.time.back() / every * (1 + 1e-12)) + 1) * every;
  }
}

}  // namespace krater
