// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/simulation/stage_timer.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <limits>

#include "krater/core/batch_types.hpp"

namespace krater {

namespace {

constexpr int kGroups = 8;   // a batch of the gather: what stages work on at once
constexpr int kRepeats = 3;  // the least of them: others disturb, nobody helps
constexpr int kTensor = 9;
constexpr int kZeros = 9 * kLanes;

/// dt L of the lane group `g` over tensor axes, the hoop strain about an axis among them.
void fill_gradient(const Simulation& sim, const Body& body, const double* state, double* out) {
  const Frame frame = sim.scene().frame;
  const int dim = dimension(frame);
  const auto column = [&](const FieldInfo& field, int component) {
    return state + body.slot(field, component) * kLanes;
  };
  std::fill_n(out, kTensor * kLanes, 0.0);
  for (int i = 0; i < dim; ++i)
    for (int a = 0; a < dim; ++a) {
      const double* L = column(field::AffineVelocity::info, dim * i + a);
      double* to = out + (3 * tensor_axis(frame, i) + tensor_axis(frame, a)) * kLanes;
      for (int lane = 0; lane < kLanes; ++lane) to[lane] = sim.dt() * L[lane];
    }
  if (frame != Frame::axisymmetric) return;
  const double *r = column(field::Position::info, 0), *v = column(field::Velocity::info, 0);
  for (int lane = 0; lane < kLanes; ++lane)
    out[4 * kLanes + lane] = r[lane] > 0 ? sim.dt() * v[lane] / r[lane] : 0;
}

}  // namespace

std::optional<PointSample> sample_points(const Simulation& sim, int body, std::int64_t turn) {
  const Body& of = *sim.bodies()[static_cast<std::size_t>(body)];
  if (of.options().rigid() || of.slot(field::AffineVelocity::info) < 0) return std::nullopt;
  std::int64_t batches = 0;
  const auto batches_of = [](const PointStore& points) {
    return (points.groups() + kGroups - 1) / kGroups;
  };
  for (int s = 0; s < sim.set_count(); ++s)
    if (sim.set(s).body == body) batches += batches_of(*sim.set(s).points);
  if (batches == 0) return std::nullopt;
  // Turns of the golden section are spread evenly, however many there are.
  const double golden = 0.6180339887498949 * static_cast<double>(turn);
  auto wanted =
      static_cast<std::int64_t>((golden - std::floor(golden)) * static_cast<double>(batches));
  for (int s = 0; s < sim.set_count(); ++s) {
    const PointStore& points = *sim.set(s).points;
    if (sim.set(s).body != body) continue;
    if (wanted >= batches_of(points)) {
      wanted -= batches_of(points);
      continue;
    }
    const int first = static_cast<int>(wanted) * kGroups;
    PointSample out;
    out.layout = &of.layout();
    out.count = std::min(points.count() - first * kLanes, kGroups * kLanes);
    out.dt = sim.dt();
    out.length = sim.scene().grid.cell;
    const auto stride = static_cast<std::size_t>(points.stride());
    const auto groups = static_cast<std::size_t>(out.groups());
    out.state.reserve(groups * stride);
    out.gradient.reserve(groups * kTensor * kLanes);
    std::memcpy(out.state.data(), points.data() + static_cast<std::size_t>(first) * stride,
                groups * stride * sizeof(double));
    for (std::size_t g = 0; g < groups; ++g)
      fill_gradient(sim, of, out.state.data() + g * stride,
                    out.gradient.data() + g * kTensor * kLanes);
    return out;
  }
  return std::nullopt;
}

StageTimer::StageTimer(std::shared_ptr<const Scene> scene, int body, IsaLevel level)
    : scene_{std::move(scene)}, body_{*scene_, body, stage_factory(level)} {
  for (const Column& c : body_.layout().locals())
    if (c.field == &field::StepGradient::info) gradient_ = c.offset;
  zeros_.reserve(kZeros + kLanes);
}

/// Columns by name; what the sample lacks has its first value.
void StageTimer::load(const PointSample& sample) {
  const Layout& layout = body_.layout();
  const auto groups = static_cast<std::size_t>(sample.groups());
  const auto stride = static_cast<std::size_t>(layout.stride());
  const auto local = static_cast<std::size_t>(layout.local_stride_or_one());
  state_.reserve(groups * stride);
  local_.reserve(groups * local);
  std::fill_n(local_.data(), groups * local, 0.0);
  for (const Column& c : layout.columns()) {
    const Column* from = sample.layout->find(c.field->name);
    const auto size = static_cast<std::size_t>(c.components * kLanes);
    for (std::size_t g = 0; g < groups; ++g) {
      double* to = state_.data() + g * stride + c.offset;
      if (from != nullptr)
        std::memcpy(to,
                    sample.state.data() + g * static_cast<std::size_t>(sample.layout->stride()) +
                        from->offset,
                    size * sizeof(double));
      else
        std::fill_n(to, size, c.initial);
    }
  }
  for (std::size_t g = 0; gradient_ >= 0 && g < groups; ++g)
    std::memcpy(local_.data() + g * local + gradient_,
                sample.gradient.data() + g * kTensor * kLanes, kTensor * kLanes * sizeof(double));
}

double StageTimer::apply(const PointSample& sample) {
  double* length = zeros_.data() + kZeros;
  std::fill_n(length, kLanes, sample.length);
  fault_ = {};
  const BatchData batch{.state = state_.data(),
                        .state_stride = body_.layout().stride(),
                        .local = local_.data(),
                        .local_stride = body_.layout().local_stride(),
                        .zeros = zeros_.data(),
                        .groups = sample.groups(),
                        .count = sample.count,
                        .first_group = 0,
                        .dt = sample.dt,
                        .length = length,
                        .length_stride = 0,
                        .ledger = &ledger_,
                        .fault = &fault_,
                        .energy_share = 0};
  const auto begin = std::chrono::steady_clock::now();
  for (const NamedStage& s : body_.stages()) s.stage->apply(batch);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void StageTimer::measure(const PointSample& sample) {
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kRepeats; ++k) {
    load(sample);
    least = std::min(least, apply(sample));
  }
  seconds_ += least;
  points_ += sample.count;
}

double StageTimer::nanoseconds() const {
  return points_ > 0 ? 1e9 * seconds_ / points_ : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace krater
