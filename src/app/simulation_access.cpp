// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "krater/app/simulation.hpp"
#include "krater/core/errors.hpp"

namespace krater {

const char* text_of(FaultKind kind) {
  switch (kind) {
    case FaultKind::not_finite_input:
      return "not finite before the step, or outside its block";
    case FaultKind::not_finite_velocity:
      return "grid velocity not finite";
    case FaultKind::inverted:
      return "turned inside out (det f <= 0)";
    case FaultKind::not_finite_state:
      return "stress, pressure, energy or sound speed not finite after the update";
    case FaultKind::no_convergence:
      return "constitutive update did not converge";
    case FaultKind::moved_too_far:
      return "moved by more than a block in one step";
    case FaultKind::none:
      break;
  }
  return "unknown";
}

namespace {

/// A state means nothing on another grid.
std::vector<double> grid_identity(Frame frame, const GridGeometry& g) {
  std::vector<double> out{static_cast<double>(frame), g.h};
  for (std::size_t a = 0; a < 3; ++a) out.insert(out.end(), {g.min[a], 1.0 * g.cells[a]});
  return out;
}

}  // namespace

std::size_t Simulation::point_count() const {
  std::size_t n = 0;
  for (const Patch& p : grid_.patches) n += static_cast<std::size_t>(p.count);
  return n;
}

double Simulation::bytes_per_point() const {
  double doubles = 0;
  for (const Patch& p : grid_.patches)
    doubles +=
        static_cast<double>(p.records.size() + p.tile.size() + p.beta.size()) + sizeof(Patch) / 8.0;
  doubles += static_cast<double>(grid_.node_blocks.size()) * kBlockNodes * kNodeDoubles;
  return 8 * doubles / static_cast<double>(std::max<std::size_t>(point_count(), 1));
}

void Simulation::set_value(int patch, int point, int slot, double x) {
  Patch& p = grid_.patches[static_cast<std::size_t>(patch)];
  const int stride = kernel_data_[static_cast<std::size_t>(p.body)].columns.stride;
  p.records.data()[static_cast<std::size_t>(point / kLanes) * static_cast<std::size_t>(stride) +
                   static_cast<std::size_t>(kLanes * slot + point % kLanes)] = x;
  p.settled = p.tile_current = p.tile_ahead = false;
}

std::vector<std::pair<int, int>> Simulation::points_by_id(int body) const {
  const int slot = bodies_[static_cast<std::size_t>(body)]->slot(field::Id::info);
  std::vector<std::pair<double, std::pair<int, int>>> order;
  for (std::size_t p = 0; p < grid_.patches.size(); ++p) {
    if (grid_.patches[p].body != body) continue;
    for (int i = 0; i < grid_.patches[p].count; ++i)
      order.push_back({value(static_cast<int>(p), i, slot), {static_cast<int>(p), i}});
  }
  std::sort(order.begin(), order.end());
  std::vector<std::pair<int, int>> out;
  out.reserve(order.size());
  for (const auto& entry : order) out.push_back(entry.second);
  return out;
}

Totals Simulation::totals(int body) const {
  Totals t;
  const int dim = geometry_.dimension;
  for (std::size_t p = 0; p < grid_.patches.size(); ++p) {
    const Patch& patch = grid_.patches[p];
    if (body >= 0 && patch.body != body) continue;
    const PointColumns& c = kernel_data_[static_cast<std::size_t>(patch.body)].columns;
    for (int i = 0; i < patch.count; ++i) {
      const auto at = [&](int offset, int k) {
        return value(static_cast<int>(p), i, offset / kLanes + k);
      };
      const double m = at(c.mass, 0);
      t.count += 1;
      t.mass += m;
      t.kinetic += point_kinetic(patch, i, c, geometry_);
      if (c.energy >= 0) t.internal += m * at(c.energy, 0);
      for (int a = 0; a < dim; ++a)
        t.momentum[static_cast<std::size_t>(a)] += m * at(c.velocity, a);
      // Plane of rotation: grid axes 0 and 1 (x and y in 3d, x and z in plane strain).
      t.angular_momentum +=
          m * (at(c.position, 0) * at(c.velocity, 1) - at(c.position, 1) * at(c.velocity, 0));
      if (c.affine < 0) continue;
      // The lever of the affine part is F (X_I - X_p), with F = I on the current configuration.
      const auto F = [&](int k, int a) {
        return c.map >= 0 ? at(c.map, dim * k + a) : (k == a ? 1.0 : 0.0);
      };
      for (int a = 0; a < dim; ++a)
        t.angular_momentum += m * 0.25 * geometry_.h * geometry_.h *
                              (F(0, a) * at(c.affine, dim + a) - F(1, a) * at(c.affine, a));
    }
  }
  return t;
}

std::string Simulation::describe_point(int patch, int point) const {
  const Patch& p = grid_.patches[static_cast<std::size_t>(patch)];
  const Body& body = *bodies_[static_cast<std::size_t>(p.body)];
  std::string position;
  for (int a = 0; a < geometry_.dimension; ++a)
    position += fmt::format("{}{} = {:.6e} m", a > 0 ? ", " : "", axis_name(scene_.frame, a),
                            value(patch, point, body.slot(field::Position::info, a)));
  return fmt::format("body '{}', point {:.0f} at {}", body.name(),
                     value(patch, point, body.slot(field::Id::info)), position);
}

std::string Simulation::describe_fault(const StepFault& fault) const {
  const Patch& patch = grid_.patches[static_cast<std::size_t>(fault.patch)];
  int lane = 0;
  while (lane < kLanes - 1 && ((fault.fault.lanes >> lane) & 1U) == 0) ++lane;
  const int point = std::min(kLanes * fault.fault.group + lane, patch.count - 1);
  std::string field = "all fields finite";
  for (const Column& c : bodies_[static_cast<std::size_t>(patch.body)]->layout().columns())
    for (int k = 0; k < c.components && field == "all fields finite"; ++k) {
      const double x = value(fault.patch, point, c.offset / kLanes + k);
      if (!std::isfinite(x))
        field = fmt::format("field '{}' component {} is {}", c.field->name, k, x);
    }
  return fmt::format("{}: {}; {}; time {:.6e} s, step {}", describe_point(fault.patch, point),
                     text_of(fault.fault.kind), field, time_, steps_);
}

Checkpoint Simulation::save() const {
  Checkpoint out;
  const auto numbers = [&out](std::string name, std::vector<double> x) {
    CheckpointBlob b;
    b.name = std::move(name);
    b.shape = {x.size()};
    b.doubles = std::move(x);
    out.blobs.push_back(std::move(b));
  };
  const auto integers = [&out](std::string name, std::vector<std::int64_t> x) {
    CheckpointBlob b;
    b.name = std::move(name);
    b.shape = {x.size()};
    b.integers = std::move(x);
    out.blobs.push_back(std::move(b));
  };
  numbers("clock", {time_, dt_, dt_free_, min_step_, max_rate_});
  integers("counters", {steps_, limiter_kind_});
  numbers("grid", grid_identity(scene_.frame, geometry_));
  static_assert(std::is_trivially_copyable_v<Audit> && sizeof(Audit) % sizeof(double) == 0);
  const auto* audit = reinterpret_cast<const double*>(&step_->audit());
  numbers("audit", std::vector<double>(audit, audit + sizeof(Audit) / sizeof(double)));
  std::vector<double> rigid;
  for (const RigidBody& body : rigid_.all()) {
    const std::vector<double> state = body.state();
    rigid.insert(rigid.end(), state.begin(), state.end());
  }
  if (rigid_.any()) numbers("rigid", std::move(rigid));
  std::vector<std::int64_t> patches;
  for (const Patch& p : grid_.patches) {
    for (int a = 0; a < 3; ++a) patches.push_back(p.key.i[static_cast<std::size_t>(a)]);
    patches.push_back(p.body);
    patches.push_back(p.count);
  }
  integers("patches", std::move(patches));
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    for (const Column& c : bodies_[b]->layout().columns())
      for (int k = 0; k < c.components; ++k) {
        std::vector<double> x;
        for (std::size_t p = 0; p < grid_.patches.size(); ++p)
          if (grid_.patches[p].body == static_cast<int>(b))
            for (int i = 0; i < grid_.patches[p].count; ++i)
              x.push_back(value(static_cast<int>(p), i, c.offset / kLanes + k));
        numbers(fmt::format("{}/{}/{}", bodies_[b]->name(), c.field->name, k), std::move(x));
      }
  return out;
}

void Simulation::restore_rigid(const std::vector<double>& state) {
  if (state.size() != RigidBody::kStateSize * rigid_.all().size())
    throw InputError(
        "checkpoint: it belongs to a scene with other rigid bodies; restart with the scene and the "
        "--set options it was written with");
  for (std::size_t i = 0; i < rigid_.all().size(); ++i)
    rigid_.all()[i].set_state(state.data() + i * RigidBody::kStateSize);
}

void Simulation::restore(const Checkpoint& checkpoint) {
  const auto find = [&](const std::string& name) -> const CheckpointBlob& {
    for (const CheckpointBlob& b : checkpoint.blobs)
      if (b.name == name) return b;
    throw InputError("checkpoint has no '" + name +
                     "': it belongs to another scene (a body, law or method differs)");
  };
  if (find("grid").doubles != grid_identity(scene_.frame, geometry_))
    throw InputError(
        "checkpoint: it belongs to a scene with another frame, grid.cell or grid.box; restart with "
        "the scene and the --set options it was written with");
  const auto& clock = find("clock").doubles;
  time_ = clock.at(0), dt_ = clock.at(1), dt_free_ = clock.at(2), max_rate_ = clock.at(4);
  steps_ = find("counters").integers.at(0);
  limiter_kind_ = static_cast<int>(find("counters").integers.at(1));
  const auto& audit = find("audit").doubles;
  if (audit.size() != sizeof(Audit) / sizeof(double))
    throw InputError("checkpoint was written by another version of krater");
  std::copy(audit.begin(), audit.end(), reinterpret_cast<double*>(&step_->audit()));

  if (rigid_.any()) restore_rigid(find("rigid").doubles);
  const auto& patches = find("patches").integers;
  grid_.patches.clear();
  for (std::size_t i = 0; i + 4 < patches.size(); i += 5) {
    grid_.patches.emplace_back();
    Patch& p = grid_.patches.back();
    for (std::size_t a = 0; a < 3; ++a) p.key.i[a] = static_cast<std::int32_t>(patches[i + a]);
    p.body = static_cast<int>(patches[i + 3]);
    p.count = static_cast<int>(patches[i + 4]);
    const int stride = kernel_data_.at(static_cast<std::size_t>(p.body)).columns.stride;
    p.records.reserve(static_cast<std::size_t>(p.groups()) * static_cast<std::size_t>(stride));
  }
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    for (const Column& c : bodies_[b]->layout().columns())
      for (int k = 0; k < c.components; ++k) {
        const std::vector<double>& x =
            find(fmt::format("{}/{}/{}", bodies_[b]->name(), c.field->name, k)).doubles;
        std::size_t at = 0;
        for (std::size_t p = 0; p < grid_.patches.size(); ++p)
          if (grid_.patches[p].body == static_cast<int>(b))
            for (int i = 0; i < grid_.patches[p].count; ++i)
              set_value(static_cast<int>(p), i, c.offset / kLanes + k, x.at(at++));
        if (at != x.size())
          throw InputError("checkpoint: column '" + std::string{c.field->name} +
                           "' has the wrong length");
      }
  for (Patch& p : grid_.patches) {
    const PointColumns& c = kernel_data_[static_cast<std::size_t>(p.body)].columns;
    if (p.count > 0) pad(p, c.stride, c.mass);
  }
  grid_.rebuild(true);
  step_->relink();
}

}  // namespace krater
