// SPDX-License-Identifier: GPL-3.0-or-later
// The state of a simulation as blobs. All that belongs to a body stands under its name, so the
// order of the bodies in the scene may change.
#include <algorithm>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "krater/core/errors.hpp"
#include "krater/simulation/simulation.hpp"

namespace krater {

namespace {

/// A state means nothing on another grid.
std::vector<double> grid_identity(Frame frame, const GridGeometry& g) {
  std::vector<double> out{static_cast<double>(frame), g.h};
  for (std::size_t a = 0; a < 3; ++a) out.insert(out.end(), {g.min[a], 1.0 * g.cells[a]});
  return out;
}

CheckpointBlob numbers(std::string name, std::vector<double> x) {
  const std::vector<std::uint64_t> shape{x.size()};
  return {std::move(name), shape, std::move(x), {}, {}};
}

CheckpointBlob integers(std::string name, std::vector<std::int64_t> x) {
  const std::vector<std::uint64_t> shape{x.size()};
  return {std::move(name), shape, {}, std::move(x), {}};
}

std::string blob_name(const Body& body, const char* part) {
  return "bodies/" + body.name() + "/" + part;
}

/// What the rows of "points" are: "position 2, velocity 2, ...".
std::string columns_text(const Body& body) {
  std::string text;
  for (const Column& c : body.layout().columns())
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", c.field->name, c.components);
  return text;
}

/// The slots of a body, in the order of the rows of "points".
std::vector<int> all_slots(const Body& body) {
  std::vector<int> slots;
  for (const Column& c : body.layout().columns())
    for (int k = 0; k < c.components; ++k) slots.push_back(c.offset / kLanes + k);
  return slots;
}

/// The entries of the account: "kinetic, internal, ...".
std::string audit_text() {
  std::string text;
  const Audit audit;
  for_each_entry(audit, [&text](const char* name, double) {
    text += (text.empty() ? "" : ", ") + std::string{name};
  });
  return text;
}

const CheckpointBlob& demand(const Checkpoint& checkpoint, const std::string& name) {
  if (const CheckpointBlob* blob = checkpoint.find(name)) return *blob;
  throw InputError("checkpoint has no '" + name +
                   "': it belongs to another scene (a body, law or method differs)");
}

/// take(key, points) for the patches of a body, in their order.
template <class Take>
void for_saved_patches(const Checkpoint& checkpoint, const Body& body, const Take& take) {
  const auto& words = demand(checkpoint, blob_name(body, "patches")).integers;
  for (std::size_t i = 0; i + 4 < words.size(); i += 5) {
    BlockKey key;
    for (std::size_t a = 0; a < 3; ++a) key.i[a] = static_cast<std::int32_t>(words[i + a]);
    key.level = static_cast<std::int32_t>(words[i + 3]);
    take(key, static_cast<int>(words[i + 4]));
  }
}

}  // namespace

std::string Simulation::impulse_name(const ImpulsePair& p) const {
  const auto body = [this](int b) { return bodies_[static_cast<std::size_t>(b)]->name(); };
  return fmt::format("impulses/{}/{}",
                     scene_.contact.active ? body(body_of(p.on)) : std::string{"all"},
                     p.by.kind == Partner::Kind::body ? "body " + body(p.by.number)
                                                      : fmt::format("side {}", p.by.number));
}

void Simulation::save_body(int b, Checkpoint& out) const {
  const Body& body = *bodies_[static_cast<std::size_t>(b)];
  std::vector<std::int64_t> keys;
  const std::vector<int> sets = sets_of(b);
  for (const int s : sets) {
    if (s < first_points()) continue;
    const Patch& patch = grid_.patches()[static_cast<std::size_t>(s - first_points())];
    if (patch.count() == 0) continue;
    keys.insert(keys.end(), patch.key.i.begin(), patch.key.i.end());
    keys.push_back(patch.key.level);
    keys.push_back(patch.count());
  }
  out.blobs.push_back(integers(blob_name(body, "patches"), std::move(keys)));
  out.blobs.push_back({blob_name(body, "columns"), {}, {}, {}, columns_text(body)});
  std::uint64_t points = 0;
  for (const int s : sets) points += static_cast<std::uint64_t>(count_of(s));
  const std::vector<int> slots = all_slots(body);
  const std::vector<std::uint64_t> shape{slots.size(), points};
  out.blobs.push_back({blob_name(body, "points"),
                       shape,
                       {},
                       {},
                       {},
                       [this, b, slots, points](std::size_t first, std::size_t count, double* to) {
                         for (std::size_t row = first; row < first + count; ++row, to += points)
                           copy_column(b, slots[row], to);
                       }});
  if (is_mesh(b)) out.blobs.push_back(numbers(blob_name(body, "mesh"), mesh_->state(mesh_set(b))));
  if (is_sph(b) && !sets.empty())
    out.blobs.push_back(
        numbers(blob_name(body, "particles"), sph_->state(sets.front() - mesh_sets())));
  if (const RigidBody* rigid = rigid_.find(b))
    out.blobs.push_back(numbers(blob_name(body, "rigid"), rigid->state()));
}

/// The map of the levels, and where the numbers of new points go on.
void Simulation::save_levels(Checkpoint& out) const {
  std::vector<double> ids;
  for (const PointSize& size : step_->sizes()) ids.push_back(size.next_id);
  if (makes_points()) out.blobs.push_back(numbers("levels/next_ids", std::move(ids)));
  if (scene_.grid.refine.empty()) return;
  std::vector<std::int64_t> map;
  for (const BlockKey& key : grid_.levels().refined()) {
    map.insert(map.end(), key.i.begin(), key.i.end());
    map.push_back(key.level);
  }
  out.blobs.push_back(integers("levels/refined", std::move(map)));
  out.blobs.push_back(integers("levels/rules", refinement_->state()));
}

bool Simulation::makes_points() const {
  return !scene_.grid.refine.empty() ||
         scene_.method.numerical_fracture == NumericalFracture::split;
}

void Simulation::restore_levels(const Checkpoint& checkpoint) {
  if (makes_points()) {
    const auto& ids = demand(checkpoint, "levels/next_ids").doubles;
    for (std::size_t b = 0; b < step_->sizes().size() && b < ids.size(); ++b)
      step_->sizes()[b].next_id = ids[b];
  }
  if (scene_.grid.refine.empty()) {
    if (checkpoint.find("levels/refined") != nullptr)
      throw InputError("checkpoint: it belongs to a scene with grid.refine");
    return;
  }
  const auto& map = demand(checkpoint, "levels/refined").integers;
  BlockSet refined;
  for (std::size_t i = 0; i + 3 < map.size(); i += 4) {
    BlockKey key;
    for (std::size_t a = 0; a < 3; ++a) key.i[a] = static_cast<std::int32_t>(map[i + a]);
    key.level = static_cast<std::int32_t>(map[i + 3]);
    refined.insert(key);
  }
  grid_.set_levels(std::move(refined));
  refinement_->restore(demand(checkpoint, "levels/rules").integers);
}

Checkpoint Simulation::save() const {
  Checkpoint out;
  out.blobs.push_back(numbers("clock", {time(), dt(), dt_free(), clock_.least(), limit_.rate,
                                        1.0 * limit_.body, limit_.id}));
  out.blobs.push_back(integers("counters", {steps(), limit_.kind}));
  out.blobs.push_back(numbers("grid", grid_identity(scene_.frame, geometry_)));
  std::vector<double> entries;
  for_each_entry(audit_, [&](const char*, double value) { entries.push_back(value); });
  out.blobs.push_back(numbers("audit/entries", std::move(entries)));
  out.blobs.push_back({"audit/names", {}, {}, {}, audit_text()});
  for (const ImpulsePair& p : impulses_.pairs())
    out.blobs.push_back(numbers(impulse_name(p), {p.impulse[0], p.impulse[1], p.impulse[2]}));
  warnings_.save(out);
  save_levels(out);
  for (std::size_t b = 0; b < bodies_.size(); ++b) save_body(static_cast<int>(b), out);
  return out;
}

void Simulation::restore_columns(const CheckpointBlob& points, const Body& body,
                                 const std::vector<int>& sets) {
  std::uint64_t count = 0;
  for (const int s : sets) count += static_cast<std::uint64_t>(count_of(s));
  const std::vector<int> slots = all_slots(body);
  if (!points.matrix || points.shape != std::vector<std::uint64_t>{slots.size(), count})
    throw InputError("checkpoint: body '" + body.name() +
                     "' has another number of points or columns there");
  std::vector<double> x(count);
  for (std::size_t row = 0; row < slots.size(); ++row) {
    points.matrix(row, 1, x.data());
    const double* from = x.data();
    for (const int s : sets) {
      PointStore& to = change(s);  // empty where another rank has them
      for (int i = 0; i < to.count(); ++i) to.at(kLanes * slots[row], i) = from[i];
      from += count_of(s);
    }
  }
}

void Simulation::restore_body(int b, const Checkpoint& checkpoint) {
  const Body& body = *bodies_[static_cast<std::size_t>(b)];
  if (demand(checkpoint, blob_name(body, "columns")).text != columns_text(body))
    throw InputError("checkpoint: body '" + body.name() +
                     "' has other columns there: another law, method or version of krater");
  if (is_sph(b)) return restore_particles(b, checkpoint);
  const CheckpointBlob& points = demand(checkpoint, blob_name(body, "points"));
  const PointColumns& columns = kernel_data_[static_cast<std::size_t>(b)].columns;
  const std::size_t first = grid_.patches().size();
  std::uint64_t count = 0;
  for_saved_patches(checkpoint, body, [&](const BlockKey& key, int held) {
    Patch& patch = grid_.add_patch(key, b, columns.stride);
    if (patch.here)
      patch.points.resize(held);
    else
      patch.held = held;
    count += static_cast<std::uint64_t>(held);
  });
  std::vector<int> sets(grid_.patches().size() - first);
  std::iota(sets.begin(), sets.end(), first_points() + static_cast<int>(first));
  if (is_mesh(b)) {
    resize_mesh(b, checkpoint, count);
    sets.insert(sets.begin(), mesh_set(b));
  }
  restore_columns(points, body, sets);
  for (std::size_t p = first; p < grid_.patches().size(); ++p)
    if (!grid_.patches()[p].points.empty()) grid_.patches()[p].points.pad(columns.mass);
  if (is_mesh(b)) restore_mesh(b, checkpoint);
  for (RigidBody& rigid : rigid_.all()) {
    if (rigid.options().body != b) continue;
    const std::vector<double>& state = demand(checkpoint, blob_name(body, "rigid")).doubles;
    if (state.size() != RigidBody::kStateSize)
      throw InputError("checkpoint was written by another version of krater");
    rigid.set_state(state.data());
  }
}

/// Before any of its patches is made.
void Simulation::deal_saved(const Checkpoint& checkpoint) {
  std::map<BlockKey, double> points;
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    for_saved_patches(checkpoint, *bodies_[b],
                      [&](const BlockKey& key, int count) { points[key] += count; });
  ranks_->deal(grid_, points);
}

void Simulation::restore_here(const Checkpoint& checkpoint) {
  if (demand(checkpoint, "grid").doubles != grid_identity(scene_.frame, geometry_))
    throw InputError(
        "checkpoint: it belongs to a scene with another frame, grid.cell or grid.box; restart with "
        "the scene and the --set options it was written with");
  seen_.clear();
  const auto& clock = demand(checkpoint, "clock").doubles;
  clock_.restore(clock.at(0), clock.at(1), clock.at(2),
                 demand(checkpoint, "counters").integers.at(0));
  limit_ = {clock.at(4), 0, static_cast<int>(clock.at(5)), clock.at(6)};
  boundary_.set_time(time());
  step_->set_last_step(dt());
  limit_.kind = static_cast<int>(demand(checkpoint, "counters").integers.at(1));
  const auto& entries = demand(checkpoint, "audit/entries").doubles;
  if (demand(checkpoint, "audit/names").text != audit_text() || entries.size() != audit_entries())
    throw InputError("checkpoint was written by another version of krater");
  std::size_t entry = 0;
  for_each_entry(audit_, [&](const char*, double& value) { value = entries[entry++]; });
  for (ImpulsePair& p : impulses_.pairs())  // of a measure that is new: from now on
    if (const CheckpointBlob* blob = checkpoint.find(impulse_name(p)))
      std::copy_n(blob->doubles.begin(), 3, p.impulse.begin());
  warnings_.restore(checkpoint);
  grid_.drop_patches();
  restore_levels(checkpoint);
  if (ranks_) deal_saved(checkpoint);
  for (std::size_t b = 0; b < bodies_.size(); ++b) restore_body(static_cast<int>(b), checkpoint);
  grid_.rebuild(true);
  step_->relink();
}

}  // namespace krater
