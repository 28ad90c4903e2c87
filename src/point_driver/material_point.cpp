// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/point_driver/material_point.hpp"

#include <algorithm>

#include "krater/simulation/material_plan.hpp"

namespace krater {

namespace {

constexpr const char* kDriver = "point";
constexpr int kZeros = 9 * kLanes;

}  // namespace

MaterialPoint::MaterialPoint(const MaterialOptions& material, double length,
                             const StageFactory& factory)
    : layout_{3} {
  layout_.state<field::Mass>(0, kDriver);
  layout_.state<field::Density>(material.density, kDriver);
  gradient_ = layout_.local_output<field::StepGradient>(kDriver).offset;
  stages_ = make_stages(factory, material_plan(material), layout_);
  layout_.check();
  const auto size =
      static_cast<std::size_t>(kZeros + kLanes + layout_.stride() + layout_.local_stride());
  buffer_.reserve(size);
  zeros_ = buffer_.data();
  length_ = zeros_ + kZeros;
  std::fill_n(length_, kLanes, length);
  state_ = length_ + kLanes;
  local_ = state_ + layout_.stride();
  for (const Column& c : layout_.columns())
    for (int k = 0; k < c.components; ++k) set(*c.field, k, c.initial);
  for (int k = 0; k < 9; k += 4) set(field::DeformationGradient::info, k, 1.0);
  state_[layout_.find(field::Mass::info.name)->offset] = 1.0;  // the padding has none
}

void MaterialPoint::step(const Eigen::Matrix3d& map, double dt) {
  for (int k = 0; k < 9; ++k)
    std::fill_n(local_ + gradient_ + k * kLanes, kLanes, map(k / 3, k % 3));
  fault_ = {};
  const BatchData batch{.state = state_,
                        .state_stride = layout_.stride(),
                        .local = local_,
                        .local_stride = layout_.local_stride(),
                        .zeros = zeros_,
                        .groups = 1,
                        .count = 1,
                        .first_group = 0,
                        .dt = dt,
                        .length = length_,
                        .length_stride = 0,
                        .ledger = &ledger_,
                        .fault = &fault_};
  for (const NamedStage& s : stages_) s.stage->apply(batch);
}

double MaterialPoint::value(const FieldInfo& field, int component, double absent) const {
  const Column* c = layout_.find(field.name);
  return c == nullptr ? absent : state_[c->offset + component * kLanes];
}

void MaterialPoint::set(const FieldInfo& field, int component, double value) {
  const Column* c = layout_.find(field.name);
  if (c != nullptr) std::fill_n(state_ + c->offset + component * kLanes, kLanes, value);
}

Eigen::Matrix3d MaterialPoint::stress() const {
  const auto s = [this](int k) { return value(field::DeviatoricStress::info, k); };
  Eigen::Matrix3d sigma;
  sigma << s(0), s(5), s(4), s(5), s(1), s(3), s(4), s(3), s(2);
  sigma.diagonal().array() -= value(field::Pressure::info) + value(field::ViscousPressure::info);
  return sigma;
}

MaterialPoint::State MaterialPoint::save() const {
  return {{state_, state_ + layout_.stride()}, ledger_};
}

void MaterialPoint::restore(const State& state) {
  std::copy(state.columns.begin(), state.columns.end(), state_);
  ledger_ = state.ledger;
}

}  // namespace krater
