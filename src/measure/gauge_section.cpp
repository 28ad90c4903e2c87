// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/measure/gauge_section.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "krater/points/fields.hpp"

namespace krater {

namespace {

/// Place of a component in the columns of symmetric tensors: 00 11 22 12 02 01.
int tensor_place(int i, int j) { return i == j ? i : 6 - i - j; }

}  // namespace

bool find_section_field(const Body& body, Frame frame, std::string_view name, GaugeField& out) {
  using Kind = GaugeField::Kind;
  const bool stressed = body.slot(field::DeviatoricStress::info) >= 0;
  const auto set = [&out](Kind kind, int component, const char* unit) {
    out.kind = kind;
    out.component = component;
    out.unit = unit;
    return true;
  };
  if (name == "area") return set(Kind::area, -1, "m^2");
  if (name == "mass_flux") return set(Kind::mass_flux, -1, "kg/s");
  for (int a = 0; a < dimension(frame); ++a) {
    const std::string axis{axis_name(frame, a)};
    if (name == "force_" + axis && stressed) return set(Kind::force, a, "N");
    if (name == "momentum_flux_" + axis) return set(Kind::momentum_flux, a, "N");
  }
  return false;
}

SectionReader::SectionReader(const Simulation& sim, const Body& body, const Triple& normal)
    : sim_{sim},
      normal_{normal},
      x_{body.slot(field::Position::info)},
      v_{body.slot(field::Velocity::info)},
      m_{body.slot(field::Mass::info)},
      rho_{body.slot(field::Density::info)},
      s_{body.slot(field::DeviatoricStress::info)},
      p_{body.slot(field::Pressure::info)},
      q_{body.slot(field::ViscousPressure::info)} {}

double SectionReader::along(int slot, int set, int point) const {
  double sum = 0;
  for (int a = 0; a < sim_.geometry().dimension; ++a)
    sum += normal_[static_cast<std::size_t>(a)] * sim_.value(set, point, slot + a);
  return sum;
}

SectionPlane SectionReader::through(int set, int point) const {
  return {along(x_, set, point), along(v_, set, point)};
}

double SectionReader::area(const SectionPlane& plane, int set, int point) const {
  const double inv_h = sim_.geometry().inv_h;
  const double w = std::max(0.0, 1 - std::abs(along(x_, set, point) - plane.at) * inv_h);
  return w > 0 ? w * inv_h * sim_.value(set, point, m_) / sim_.value(set, point, rho_) : 0;
}

double SectionReader::traction(int axis, int set, int point) const {
  const Frame frame = sim_.scene().frame;
  double pressure = p_ >= 0 ? sim_.value(set, point, p_) : 0;
  if (q_ >= 0) pressure += sim_.value(set, point, q_);
  double sum = -pressure * normal_[static_cast<std::size_t>(axis)];
  for (int b = 0; b < sim_.geometry().dimension; ++b)
    sum +=
        sim_.value(set, point, s_ + tensor_place(tensor_axis(frame, axis), tensor_axis(frame, b))) *
        normal_[static_cast<std::size_t>(b)];
  return sum;
}

double SectionReader::value(const SectionPlane& plane, const GaugeField& field, int set,
                            int point) const {
  using Kind = GaugeField::Kind;
  if (field.kind == Kind::area) return 1;
  if (field.kind == Kind::force) return traction(field.component, set, point);
  const double passing = sim_.value(set, point, rho_) * (along(v_, set, point) - plane.speed);
  if (field.kind == Kind::mass_flux) return passing;
  return passing * sim_.value(set, point, v_ + field.component);
}

}  // namespace krater
