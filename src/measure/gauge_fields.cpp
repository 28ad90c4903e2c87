// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/measure/gauge_fields.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include "krater/core/errors.hpp"
#include "krater/measure/gauge_section.hpp"
#include "krater/points/fields.hpp"

namespace krater {

namespace {

constexpr std::string_view kRate = "_rate", kStress = "stress_";

/// Component of a symmetric tensor by its name in the frame; -1: none.
int tensor_component(Frame frame, std::string_view name) {
  constexpr std::array<std::string_view, 6> space{"xx", "yy", "zz", "yz", "xz", "xy"},
      round{"rr", "tt", "zz", "tz", "rz", "rt"};
  const auto& names = frame == Frame::axisymmetric ? round : space;
  const auto at = std::find(names.begin(), names.end(), name);
  return at == names.end() ? -1 : static_cast<int>(at - names.begin());
}

int component_of(Frame frame, std::string_view name, std::string_view prefix) {
  return name.starts_with(prefix) ? tensor_component(frame, name.substr(prefix.size())) : -1;
}

/// Component of 1/2 ln(F F^T).
double hencky(const Eigen::Matrix3d& F, int component) {
  constexpr std::array<std::array<int, 2>, 6> place{
      {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}};
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver{F * F.transpose()};
  const Eigen::Matrix3d& N = solver.eigenvectors();
  const auto [i, j] = place[static_cast<std::size_t>(component)];
  double sum = 0;
  for (int k = 0; k < 3; ++k) sum += 0.5 * std::log(solver.eigenvalues()[k]) * N(i, k) * N(j, k);
  return sum;
}

/// A column by its name, components of vectors by axis; false: none. `known` lists all.
bool find_column(const Body& body, Frame frame, const std::string& name, GaugeField& out,
                 std::string& known) {
  for (const Column& c : body.layout().columns()) {
    const FieldInfo& field = *c.field;
    const bool vector = field.components == kPerAxis;
    for (int a = 0; a < c.components && (vector || c.components == 1); ++a) {
      const std::string axis = vector ? "_" + std::string{axis_name(frame, a)} : "";
      known += ", " + (field.name + axis);
      if (name != field.name + axis) continue;
      out.slot = c.offset / kLanes + a;
      out.unit = field.unit;
      return true;
    }
  }
  return false;
}

bool find_derived(const Body& body, Frame frame, std::string_view name, GaugeField& out) {
  using Kind = GaugeField::Kind;
  const int s = body.slot(field::DeviatoricStress::info),
            F = body.slot(field::DeformationGradient::info);
  const int stress = component_of(frame, name, kStress),
            strain = component_of(frame, name, kStrain);
  if (name == "speed") {
    out = {Kind::speed, body.slot(field::Velocity::info), -1, -1, "m/s", out.change};
  } else if (name == "von_mises" && s >= 0) {
    out = {Kind::von_mises, s, -1, -1, "Pa", out.change};
  } else if (stress >= 0 && s >= 0) {
    out = {Kind::stress, s + stress, stress < 3 ? body.slot(field::Pressure::info) : -1,
           -1,           "Pa",       out.change};
  } else if (strain >= 0 && F >= 0) {
    out = {Kind::strain, F, -1, strain, "1", out.change};
  } else {
    return false;
  }
  return true;
}

}  // namespace

GaugeField find_gauge_field(const Simulation& sim, const GaugeOptions& gauge, std::string name) {
  const Body& body = *sim.bodies()[static_cast<std::size_t>(gauge.body)];
  const Frame frame = sim.scene().frame;
  GaugeField out;
  if (name.ends_with(kRate)) {
    out.change = GaugeField::Change::rate;
    name.resize(name.size() - kRate.size());
  }
  std::string known;
  const bool found = find_column(body, frame, name, out, known) ||
                     find_derived(body, frame, name, out) ||
                     (gauge.normal && find_section_field(body, frame, name, out));
  if (!found)
    throw InputError(fmt::format(
        "{}.fields: the points of {} carry no '{}' (known: speed, von_mises{}, stress_{}, "
        "strain_{}, "
        "..., {}, and each with _rate)",
        gauge.where, body.name(), name, known, frame == Frame::axisymmetric ? "rr" : "xx",
        frame == Frame::axisymmetric ? "rr" : "xx",
        gauge.normal ? "of the section area, force_z, mass_flux, momentum_flux_z, ..."
                     : "with section: area, force_z, mass_flux, momentum_flux_z"));
  if (out.change == GaugeField::Change::rate) out.unit += " s^-1";
  return out;
}

GaugeField measure_field(const Scene& scene, int measure, const std::string& name) {
  using Change = GaugeField::Change;
  const MeasureOptions& m = scene.measures[static_cast<std::size_t>(measure)];
  GaugeField out{GaugeField::Kind::measure, measure, -1, -1, unit_of(m), Change::none};
  if (m.kind == MeasureKind::force) out.change = Change::rate;
  if (m.kind == MeasureKind::deceleration) out.change = Change::fall;
  if (name == m.name) return out;
  out.change = Change::rate;
  out.unit += " s^-1";
  return out;
}

double value_at(const Simulation& sim, const GaugeField& field, int set, int point) {
  const auto at = [&](int k) { return sim.value(set, point, field.slot + k); };
  double square = 0;
  switch (field.kind) {
    case GaugeField::Kind::scalar:
      return at(0);
    case GaugeField::Kind::stress:
      return at(0) - (field.pressure < 0 ? 0 : sim.value(set, point, field.pressure));
    case GaugeField::Kind::speed:
      for (int a = 0; a < sim.geometry().dimension; ++a) square += at(a) * at(a);
      return std::sqrt(square);
    case GaugeField::Kind::von_mises:
      for (int k = 0; k < 6; ++k) square += (k < 3 ? 1 : 2) * at(k) * at(k);
      return std::sqrt(1.5 * square);
    case GaugeField::Kind::strain: {
      Eigen::Matrix3d F;
      for (int k = 0; k < 9; ++k) F(k / 3, k % 3) = at(k);
      return hencky(F, field.component);
    }
    default:
      break;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

std::vector<double> changed(const GaugeField& field, const std::vector<double>& time,
                            std::vector<double> x) {
  if (field.change == GaugeField::Change::none) return x;
  const double sign = field.change == GaugeField::Change::fall ? -1 : 1;
  if (sign < 0)
    for (double& sample : x) sample = std::abs(sample);
  for (std::size_t i = x.size(); i-- > 1;)
    x[i] = sign * (x[i] - x[i - 1]) / (time[i] - time[i - 1]);
  if (!x.empty()) x[0] = x.size() > 1 ? x[1] : std::numeric_limits<double>::quiet_NaN();
  return x;
}

}  // namespace krater
