// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file point_driver/material_point.hpp
/// One material point without a grid: a batch of one, taken through the very stages of a step
/// (materials/assembly) by maps f = I + dt L that the caller gives. Its mass is 1 kg, so that the
/// ledger's joules are joules per kilogram.
#include <vector>

#include <Eigen/Core>

#include "krater/core/aligned.hpp"
#include "krater/core/batch_types.hpp"
#include "krater/materials/assembly.hpp"
#include "krater/scene/scene.hpp"

namespace krater {

class MaterialPoint {
 public:
  /// `length`: of the element [m]. `material` must outlive the point.
  MaterialPoint(const MaterialOptions& material, double length, const StageFactory& factory);
  MaterialPoint(const MaterialPoint&) = delete;
  MaterialPoint& operator=(const MaterialPoint&) = delete;

  const std::vector<NamedStage>& stages() const { return stages_; }
  const Layout& layout() const { return layout_; }

  /// Take one step of `dt` [s]; `map` is f - I. The ledger adds up, the fault is this step's.
  void step(const Eigen::Matrix3d& map, double dt);

  /// Component of a state column; `absent` where the material has no such column.
  double value(const FieldInfo& field, int component = 0, double absent = 0.0) const;
  void set(const FieldInfo& field, int component, double value);
  Eigen::Matrix3d stress() const;  ///< Cauchy, s - (p + q_v) I, as momentum sees it [Pa]

  /// Everything that a step changes, to take it back.
  struct State {
    std::vector<double> columns;
    Ledger ledger;
  };
  State save() const;
  void restore(const State& state);

  const Ledger& ledger() const { return ledger_; }
  FaultKind fault() const { return fault_.kind; }

 private:
  Layout layout_;
  std::vector<NamedStage> stages_;
  AlignedBuffer buffer_;
  double *state_ = nullptr, *local_ = nullptr, *zeros_ = nullptr, *length_ = nullptr;
  int gradient_ = 0;  ///< offset of f - I in the local record
  Ledger ledger_;
  Fault fault_;
};

}  // namespace krater
