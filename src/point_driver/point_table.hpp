// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file point_driver/point_table.hpp
/// What `krater point` tabulates. The work is the integral of sigma:D/rho, taken from the stresses,
/// densities and maps alone, by the trapezoidal rule of the energy update: pressures over dv,
/// deviators over sym H. `energy_balance` is it less the change of internal energy: round-off for
/// laws that integrate e, second order in dt for those that give it from F.
#include <string>
#include <vector>

#include <Eigen/Core>

#include "krater/materials/scalar_eos.hpp"
#include "krater/output/results.hpp"
#include "krater/point_driver/material_point.hpp"

namespace krater {

/// Follows a point and fills the columns.
class PointRecord {
 public:
  /// `released`: from a shock, with the particle speed behind it [m/s] in a column of its own.
  PointRecord(const MaterialPoint& point, double temperature, bool released, double particle_speed);

  /// After a step of `dt` by `map`, found in `trials`. `write`: add a row.
  void follow(const Eigen::Matrix3d& map, double dt, int trials, bool write);
  const std::vector<TableColumn>& columns() const { return columns_; }
  double time() const { return time_; }
  double equivalent_strain() const { return equivalent_; }
  double work() const { return work_; }
  double energy_balance() const;

 private:
  void write_row();
  void put(const char* name, const char* unit, const char* meaning, double value);
  void put_tensor(const char* name, const char* unit, const char* meaning,
                  const Eigen::Matrix3d& value, bool whole);

  const MaterialPoint& point_;
  double start_temperature_, start_energy_;
  bool released_;
  double particle_speed_;
  double time_ = 0, equivalent_ = 0, rate_ = 0, work_ = 0;
  int trials_ = 0;
  Eigen::Matrix3d F_ = Eigen::Matrix3d::Identity(), strain_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d deviator_;
  double volume_, pressure_;
  std::vector<TableColumn> columns_;
  std::size_t next_ = 0;  ///< column of the row being written
};

/// One row per state behind a shock.
std::vector<TableColumn> hugoniot_table(const std::vector<ShockState>& states, double rho0);

}  // namespace krater
