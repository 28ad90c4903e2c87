// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/measure/gauges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "krater/core/errors.hpp"
#include "krater/points/fields.hpp"

namespace krater {

namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr std::string_view kRate = "_rate";

const Body& body_of(const Simulation& sim, const GaugeOptions& gauge) {
  return *sim.bodies()[static_cast<std::size_t>(gauge.body)];
}

/// Component of a symmetric tensor by its name in the frame; -1: none.
int tensor_component(Frame frame, std::string_view name) {
  constexpr std::array<std::string_view, 6> space{"xx", "yy", "zz", "yz", "xz", "xy"},
      round{"rr", "tt", "zz", "tz", "rz", "rt"};
  const auto& names = frame == Frame::axisymmetric ? round : space;
  const auto at = std::find(names.begin(), names.end(), name);
  return at == names.end() ? -1 : static_cast<int>(at - names.begin());
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

Gauges::Source Gauges::find_source(const Simulation& sim, const GaugeOptions& gauge,
                                   std::string name) const {
  const Body& body = body_of(sim, gauge);
  Source out;
  out.rate = name.ends_with(kRate);
  if (out.rate) name.resize(name.size() - kRate.size());
  std::string known = "speed, von_mises";
  for (const Column& c : body.layout().columns()) {
    const FieldInfo& field = *c.field;
    const bool vector = field.components == kPerAxis;
    for (int a = 0; a < c.components && (vector || c.components == 1); ++a) {
      const std::string axis = vector ? "_" + std::string{axis_name(scene_.frame, a)} : "";
      known += ", " + (field.name + axis);
      if (name == field.name + axis) {
        out.slot = c.offset / kLanes + a;
        out.unit = field.unit;
        return out;
      }
    }
  }
  const int s = body.slot(field::DeviatoricStress::info);
  out.unit = name == "speed" ? "m/s" : "Pa";
  if (name == "speed") {
    out.kind = Source::Kind::speed;
    out.slot = body.slot(field::Velocity::info);
    return out;
  }
  if (s >= 0 && name == "von_mises") {
    out.kind = Source::Kind::von_mises;
    out.slot = s;
    return out;
  }
  const int k = name.starts_with("stress_") ? tensor_component(scene_.frame, name.substr(7)) : -1;
  if (s < 0 || k < 0)
    throw InputError(fmt::format(
        "{}.fields: the points of {} carry no '{}' (known: {}, stress_{}, "
        "..., and each with _rate)",
        gauge.where, body.name(), name, known, scene_.frame == Frame::axisymmetric ? "rr" : "xx"));
  out.kind = Source::Kind::stress;
  out.slot = s + k;
  if (k < 3) out.pressure = body.slot(field::Pressure::info);
  return out;
}

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

Gauges::Gauges(const Simulation& sim) : scene_{sim.scene()} {
  for (std::size_t g = 0; g < scene_.gauges.size(); ++g) {
    const GaugeOptions& gauge = scene_.gauges[g];
    Record& record = records_.emplace_back();
    for (const std::string& name : gauge.fields)
      record.sources.push_back(find_source(sim, gauge, name));
    for (std::size_t k = 0; k < gauge.at.size() && !gauge.fixed; ++k)
      record.ids.push_back(find_id(sim, gauge, k));
    record.gone.assign(gauge.at.size(), -1);
    record.values.resize(gauge.at.size() * gauge.fields.size());
    sample(sim, g);
  }
}

void Gauges::sample(const Simulation& sim, std::size_t g) {
  const GaugeOptions& gauge = scene_.gauges[g];
  Record& record = records_[g];
  const Body& body = body_of(sim, gauge);
  const int x = body.slot(field::Position::info), m = body.slot(field::Mass::info),
            id = body.slot(field::Id::info);
  const auto value = [&](const Source& source, int s, int i) {
    const auto at = [&](int k) { return sim.value(s, i, source.slot + k); };
    double square = 0;
    switch (source.kind) {
      case Source::Kind::scalar:
        return at(0);
      case Source::Kind::stress:
        return at(0) - (source.pressure < 0 ? 0 : sim.value(s, i, source.pressure));
      case Source::Kind::speed:
        for (int a = 0; a < sim.geometry().dimension; ++a) square += at(a) * at(a);
        return std::sqrt(square);
      case Source::Kind::von_mises:
        for (int k = 0; k < 6; ++k) square += (k < 3 ? 1 : 2) * at(k) * at(k);
        return std::sqrt(1.5 * square);
    }
    return kNothing;
  };
  const std::size_t fields = record.sources.size(), places = gauge.at.size();
  std::vector<double> sum(places * fields, 0.0), weight(places, 0.0);
  for_points(sim, gauge, [&](int s, int i) {
    for (std::size_t k = 0; k < places; ++k) {
      const double w = gauge.fixed ? sim.value(s, i, m) * hat(sim, x, s, i, gauge.at[k])
                       : sim.value(s, i, id) == record.ids[k] ? 1
                                                              : 0;
      if (!(w > 0)) continue;
      weight[k] += w;
      for (std::size_t f = 0; f < fields; ++f)
        sum[k * fields + f] += w * value(record.sources[f], s, i);
    }
  });
  record.time.push_back(sim.time());
  record.next = (std::floor(sim.time() / gauge.every * (1 + 1e-12)) + 1) * gauge.every;
  for (std::size_t k = 0; k < places; ++k) {
    if (!(weight[k] > 0) && record.gone[k] < 0) record.gone[k] = sim.time();
    for (std::size_t f = 0; f < fields; ++f)
      record.values[k * fields + f].push_back(weight[k] > 0 ? sum[k * fields + f] / weight[k]
                                                            : kNothing);
  }
}

void Gauges::look(const Simulation& sim) {
  for (std::size_t g = 0; g < records_.size(); ++g)
    if (sim.time() >= records_[g].next) sample(sim, g);
}

std::string Gauges::column_name(std::size_t g, std::size_t column) const {
  const GaugeOptions& gauge = scene_.gauges[g];
  const std::string& field = gauge.fields[column % gauge.fields.size()];
  return gauge.at.size() == 1 ? field : fmt::format("{}_{}", field, column / gauge.fields.size());
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
    const Source& source = record.sources[c % record.sources.size()];
    std::vector<double> values = record.values[c];
    for (std::size_t i = values.size(); source.rate && i-- > 0;)
      values[i] =
          i == 0 ? kNothing : (values[i] - values[i - 1]) / (record.time[i] - record.time[i - 1]);
    if (source.rate && values.size() > 1) values[0] = values[1];
    if (filters) values = resampled(record.time, values, gauge.every);
    const std::string unit = std::string{source.unit} + (source.rate ? " s^-1" : "");
    out.push_back({column_name(g, c), unit, "as the points have it", values});
    if (filters)
      out.push_back({column_name(g, c) + "_filtered", unit, meaning,
                     filtered(values, gauge.every, gauge.filter, gauge.frequency)});
  }
  return out;
}

void Gauges::write(ResultsFolder& results) const {
  for (std::size_t g = 0; g < records_.size(); ++g)
    results.write_table("gauge_" + scene_.gauges[g].name, table(g));
}

void Gauges::summarize(Json& summary) const {
  for (std::size_t g = 0; g < records_.size(); ++g) {
    const GaugeOptions& gauge = scene_.gauges[g];
    Json& j = summary["gauges"][gauge.name];
    j["file"] = Json::of("gauge_" + gauge.name + ".csv");
    j["body"] = Json::of(scene_.bodies[static_cast<std::size_t>(gauge.body)].name);
    j["places"] = Json::of(gauge.at.size());
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
