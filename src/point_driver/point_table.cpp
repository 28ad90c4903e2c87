// SPDX-License-Identifier: GPL-3.0-or-later
#include "point_driver/point_table.hpp"

#include <cmath>

#include "krater/point_driver/loading_path.hpp"

namespace krater {

namespace {

using Eigen::Matrix3d;

constexpr const char* kAxes[] = {"x", "y", "z"};

Matrix3d deviator_of(const Matrix3d& a) { return a - a.trace() / 3 * Matrix3d::Identity(); }

double total_pressure(const MaterialPoint& point) {
  return point.value(field::Pressure::info) + point.value(field::ViscousPressure::info);
}

}  // namespace

PointRecord::PointRecord(const MaterialPoint& point, double temperature, bool released,
                         double particle_speed)
    : point_{point},
      start_temperature_{temperature},
      start_energy_{point.value(field::InternalEnergy::info)},
      released_{released},
      particle_speed_{particle_speed},
      deviator_{deviator_of(point.stress())},
      volume_{1 / point.value(field::Density::info)},
      pressure_{total_pressure(point)} {
  write_row();
}

void PointRecord::follow(const Matrix3d& map, double dt, int trials, bool write) {
  const Matrix3d strain = strain_of(map), deviator = deviator_of(point_.stress());
  const double volume = 1 / point_.value(field::Density::info), pressure = total_pressure(point_);
  const double mean_volume = 0.5 * (volume_ + volume);
  work_ += 0.5 * mean_volume * (deviator_ + deviator).cwiseProduct(strain).sum() -
           0.5 * (pressure_ + pressure) * (volume - volume_);
  particle_speed_ += std::copysign(
      std::sqrt(std::fmax(0.0, (pressure_ - pressure) * (volume - volume_))), volume - volume_);
  const double equivalent = std::sqrt(2.0 / 3.0) * deviator_of(strain).norm();
  equivalent_ += equivalent;
  rate_ = equivalent / dt;
  time_ += dt;
  trials_ = trials;
  F_ += map * F_;
  strain_ += strain;
  deviator_ = deviator;
  volume_ = volume;
  pressure_ = pressure;
  if (write) write_row();
}

double PointRecord::energy_balance() const {
  return work_ - (point_.value(field::InternalEnergy::info) - start_energy_);
}

void PointRecord::put(const char* name, const char* unit, const char* meaning, double value) {
  if (next_ == columns_.size()) columns_.push_back({name, unit, meaning, {}});
  columns_[next_++].values.push_back(value);
}

void PointRecord::put_tensor(const char* name, const char* unit, const char* meaning,
                             const Matrix3d& value, bool whole) {
  const int symmetric[] = {0, 4, 8, 5, 2, 1};  // xx yy zz yz xz xy
  for (int i = 0; i < (whole ? 9 : 6); ++i) {
    const int k = whole ? i : symmetric[i];
    put((std::string{name} + "_" + kAxes[k / 3] + kAxes[k % 3]).c_str(), unit, meaning,
        value(k / 3, k % 3));
  }
}

void PointRecord::write_row() {
  next_ = 0;
  const auto state = [this](const FieldInfo& field, double absent = 0.0) {
    put(field.name, field.unit, field.meaning, point_.value(field, 0, absent));
  };
  const Matrix3d sigma = point_.stress();
  const double von_mises = std::sqrt(1.5) * deviator_.norm();
  const double p = point_.value(field::Pressure::info);
  put("time", "s", "time along the path", time_);
  put_tensor("strain", "1", "integral of D dt: of sym H over the steps", strain_, false);
  put_tensor("F", "1", "deformation gradient: product of the maps of the steps", F_, true);
  put("equivalent_strain", "1", "integral of the equivalent rate", equivalent_);
  put("strain_rate", "s^-1", "equivalent, sqrt(2/3 dev D : dev D), of the last step", rate_);
  put_tensor("stress", "Pa", "Cauchy stress carried, artificial viscosity included", sigma, false);
  state(field::Pressure::info);
  state(field::ViscousPressure::info);
  put("von_mises", "Pa", "von Mises stress carried, sqrt(3/2 s:s)", von_mises);
  put("triaxiality", "1", "-p/q of the stress carried; 0 where q is below 1e-12 p",
      von_mises > 1e-12 * std::fabs(p) ? -p / von_mises : 0.0);
  state(field::PlasticStrain::info);
  state(field::Temperature::info, start_temperature_);
  state(field::Damage::info);
  state(field::Failed::info);
  state(field::Density::info);
  state(field::InternalEnergy::info);
  state(field::SoundSpeed::info);
  put("work", "J/kg", "integral of sigma:D/rho dt", work_);
  put("energy_balance", "J/kg", "work less the change of internal energy", energy_balance());
  put("trials", "1", "updates that the step took to meet a prescribed stress", trials_);
  if (released_)
    put("particle_speed", "m/s", "behind the shock, and in the simple wave of release after it",
        particle_speed_);
}

std::vector<TableColumn> hugoniot_table(const std::vector<ShockState>& states, double rho0) {
  std::vector<TableColumn> table{
      {"particle_speed", "m/s", "up: of the material behind the shock", {}},
      {"shock_speed", "m/s", "Us: into material at rest", {}},
      {"pressure", "Pa", "behind the shock", {}},
      {"density", "kg/m^3", "behind the shock", {}},
      {"compression", "1", "rho/rho0", {}},
      {"internal_energy", "J/kg", "specific, behind the shock", {}},
      {"sound_speed", "m/s", "bulk, behind the shock", {}}};
  for (const ShockState& s : states) {
    const double row[] = {s.particle_speed, s.shock_speed, s.pressure,   s.density,
                          s.density / rho0, s.energy,      s.sound_speed};
    for (std::size_t k = 0; k < table.size(); ++k) table[k].values.push_back(row[k]);
  }
  return table;
}

}  // namespace krater
