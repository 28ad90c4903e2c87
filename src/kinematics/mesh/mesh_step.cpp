// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/mesh/mesh_step.hpp"

#include <algorithm>
#include <cmath>

#include "kinematics/mesh/elements.hpp"
#include "krater/core/parallel.hpp"
#include "krater/kinematics/mesh/mesh_loads.hpp"
#include "krater/kinematics/sweep_account.hpp"

namespace krater {

namespace {

constexpr std::size_t kChunkNodes = 512;

}  // namespace

ElementData MeshStep::data(Elements& b) {
  return {.elements = b.elements.data(),
          .count = b.elements.count(),
          .groups = b.elements.groups(),
          .corners = b.corners.data(),
          .shares = b.shares.data(),
          .forces = b.forces.data(),
          .hourglass = b.hourglass.data(),
          .hourglass_energy = b.hourglass_energy.data(),
          .remembered = b.remembered.data(),
          .nodes = b.nodes.data(),
          .changes = b.changes.data(),
          .placed = b.placed.data(),
          .columns = b.columns,
          .stages = b.made_of.stages,
          .stage_count = b.made_of.stage_count,
          .q_lin = b.made_of.q_lin,
          .q_quad = b.made_of.q_quad,
          .held = b.made_of.held,
          .reference = b.made_of.reference,
          .refresh_strain = b.made_of.refresh_strain};
}

ElementScratch MeshStep::scratch() {
  AlignedBuffer& mine = scratch_[static_cast<std::size_t>(thread_index())];
  double* kept = mine.data();
  double* length = kept + kElementGroups * kKeptPacks * kLanes;
  double* zeros = length + kElementGroups * kLanes;
  return {zeros + 9 * kLanes, length, kept, zeros};
}

void MeshStep::start() {
  find_forces();
  audit_.kinetic = audit_.internal = audit_.unfelt = 0;
  for (int s = 0; s < set_count(); ++s) {
    audit_.kinetic += totals(s).kinetic;
    audit_.internal += internal_energy(s);
    if (bodies_[static_cast<std::size_t>(s)]->made_of.barotropic)
      audit_.unfelt += internal_energy(s);
  }
  audit_.initial_kinetic = audit_.kinetic;
  audit_.initial_internal = audit_.internal;
  audit_.unfelt_start = audit_.unfelt;
}

NodeTotals MeshStep::totals(int s) const {
  NodeTotals t;
  const Elements& b = *bodies_[static_cast<std::size_t>(s)];
  for (std::size_t n = 0; n < b.node_count; ++n) {
    const double* node = b.nodes.data() + kNode * n;
    const double m = node[3];
    double squares = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      squares += a < static_cast<std::size_t>(dim_) ? node[4 + a] * node[4 + a] : 0;
      t.momentum[a] += a < static_cast<std::size_t>(dim_) ? m * node[4 + a] : 0;
    }
    t.mass += m;
    t.kinetic += 0.5 * m * squares;
    t.angular_momentum += m * (node[0] * node[5] - node[1] * node[4]);
  }
  return t;
}

double MeshStep::internal_energy(int s) const {
  const Elements& b = *bodies_[static_cast<std::size_t>(s)];
  double sum = 0;
  for (int i = 0; i < b.elements.count(); ++i)
    sum += b.elements.at(b.columns.mass, i) * b.elements.at(b.columns.energy, i) +
           b.hourglass_energy.data()[i];
  return sum;
}

double MeshStep::hourglass_energy() const {
  double sum = 0;
  for (const auto& b : bodies_)
    for (int i = 0; i < b->elements.count(); ++i) sum += b->hourglass_energy.data()[i];
  return sum;
}

void MeshStep::find_limit(const std::vector<ElementResult>& results) {
  limit_ = {};
  for (std::size_t c = 0; c < results.size(); ++c) {
    const ElementResult& r = results[c];
    if (r.fault.kind != FaultKind::none)
      throw ElementFault{static_cast<int>(chunks_[c].body), r.fault};
    const Elements& body = *bodies_[chunks_[c].body];
    note_limit(r, body.made_of.body, body.elements, body.columns.id, limit_);
  }
}

void MeshStep::book(const std::vector<ElementResult>& results, const Standing& others) {
  SweepAccount account{audit_, others};
  for (std::size_t c = 0; c < results.size(); ++c) {
    const ElementResult& r = results[c];
    account.add(r, r.internal + r.hourglass, r.hourglass - r.hourglass_before,
                bodies_[chunks_[c].body]->made_of.barotropic);
    audit_.new_references += r.renewed;
  }
  account.close();
}

void MeshStep::find_forces() {
  std::vector<ElementResult> results(chunks_.size());
  for_each(chunks_.size(), [&](std::size_t c) {
    const Chunk& chunk = chunks_[c];
    kernels_.forces(data(*bodies_[chunk.body]), chunk.first, chunk.last, results[c]);
  });
  find_limit(results);
}

/// work(body, first node, last node, sums) in chunks; sums in their order.
template <class Work>
void MeshStep::over_nodes(const Work& work) {
  for (auto& body : bodies_) {
    const std::size_t chunks = (body->node_count + kChunkNodes - 1) / kChunkNodes;
    std::vector<WallSums> sums(chunks);
    for_each(chunks, [&](std::size_t c) {
      work(*body, c * kChunkNodes, std::min((c + 1) * kChunkNodes, body->node_count), sums[c]);
    });
    for (const WallSums& s : sums) {
      audit_.wall_heat += s.heat;
      audit_.wall_work += s.work;
      for (std::size_t a = 0; a < 3; ++a) audit_.wall_impulse[a] += s.impulse[a];
      note_sides(*body, s);
    }
  }
}

void MeshStep::note_sides(const Elements& body, const WallSums& sums) {
  if (impulses_ == nullptr || !impulses_->any()) return;
  const FieldId on = apart_ ? own_field(body.made_of.body) : FieldId{};
  for (const PushingSide& side : pushing_) {
    const int upper = side.inwards < 0 ? 1 : 0, axis = static_cast<int>(side.axis);
    impulses_->add({{on, Partner::side(axis, upper),
                     sums.by_side[static_cast<std::size_t>(2 * axis + upper)]}});
  }
}

Triple MeshStep::force_of(int s, std::size_t node) const {
  return bodies_[static_cast<std::size_t>(s)]->force_on(node);
}

double MeshStep::force(double dt) {
  over_nodes([&](Elements& b, std::size_t first, std::size_t last, WallSums&) {
    for (std::size_t n = first; n < last; ++n) {
      const Triple f = b.force_on(n);
      // A node whose elements became points has no mass.
      const double mass = b.node(n)[3], per_mass = mass > 0 ? dt / mass : 0;
      for (std::size_t a = 0; a < 3; ++a) b.change(n)[a] = per_mass * f[a];
      b.node(n)[7] = 0;
    }
  });
  for (auto& b : bodies_) loads_->add(*b, dt);
  return dt;
}

void MeshStep::set_loads(std::unique_ptr<MeshLoads> loads) { loads_ = std::move(loads); }

void MeshStep::set_time(double time) {
  loads_->set_time(time);
  for (PushingSide& side : pushing_) side.set_time(time);
}

bool MeshStep::feels(std::size_t load) const {
  return std::any_of(bodies_.begin(), bodies_.end(),
                     [&](const auto& b) { return loads_->acts(load, *b); });
}

std::vector<MeshNodes> MeshStep::nodes() {
  std::vector<MeshNodes> out;
  for (const auto& b : bodies_)
    out.push_back({b->made_of.body, b->nodes.data(), b->changes.data(), b->node_count});
  return out;
}

void MeshStep::hold_nodes() {
  over_nodes([&](Elements& b, std::size_t first, std::size_t last, WallSums& sums) {
    hold_planes(b, first, last, sums);
  });
}

void MeshStep::meet(double dt) {
  over_nodes([&](Elements& b, std::size_t first, std::size_t last, WallSums& sums) {
    hold_planes(b, first, last, sums);
    push_from_sides(b, first, last, dt, sums);
  });
}

void MeshStep::hold_planes(Elements& b, std::size_t first, std::size_t last, WallSums& sums) const {
  for (std::size_t n = first; n < last; ++n)
    for (unsigned a = 0; b.on_plane[n] >> a != 0; ++a) {
      if ((b.on_plane[n] >> a & 1U) == 0) continue;
      double& change = b.change(n)[a];
      sums.impulse[a] -= b.node(n)[3] * (change + b.node(n)[4 + a]);
      change = -b.node(n)[4 + a];
    }
}

void MeshStep::push_from_sides(Elements& b, std::size_t first, std::size_t last, double dt,
                               WallSums& sums) const {
  if (pushing_.empty()) return;
  const auto dim = static_cast<std::size_t>(dim_);
  for (std::size_t n = first; n < last; ++n) {
    double *node = b.node(n), *change = b.change(n);
    Triple all{};
    double given = 0;  // work of sides that move, per mass
    bool pushed = false;
    for (const PushingSide& side : pushing_) {
      const double touching = (side.plane_after(dt) - node[side.axis]) / dt;
      const double missing = side.inwards * (touching - node[4 + side.axis] - change[side.axis]);
      if (!(missing > 0)) continue;
      Triple v{};
      for (std::size_t t = 0; t < dim; ++t) v[t] = node[4 + t] + change[t];
      const Triple push = side.push(v, missing, dim_);
      pushed = true;
      Triple& by_side = sums.by_side[2 * side.axis + (side.inwards < 0 ? 1 : 0)];
      for (std::size_t t = 0; t < dim; ++t) {
        change[t] += push[t];
        all[t] += push[t];
        given += push[t] * side.velocity[t];
        by_side[t] += node[3] * push[t];
      }
    }
    if (!pushed) continue;
    for (std::size_t t = 0; t < dim; ++t) {
      node[7] -= all[t] * (node[4 + t] + 0.5 * change[t]);
      sums.impulse[t] += node[3] * all[t];
    }
    node[7] += given;
    sums.work += node[3] * given;
    sums.heat += node[3] * node[7];
  }
}

Standing MeshStep::move(double dt, const Standing& others) {
  std::size_t most = 0;
  for (const auto& b : bodies_)
    most = std::max(most, static_cast<std::size_t>(b->columns.local_stride));
  scratch_.resize(static_cast<std::size_t>(threads()));
  for (AlignedBuffer& buffer : scratch_)
    buffer.reserve(kElementGroups * (kKeptPacks * kLanes + kLanes + most) + 9 * kLanes);
  for (auto& b : bodies_) loads_->book(*b, audit_);
  std::vector<ElementResult> results(chunks_.size());
  for_each(chunks_.size(), [&](std::size_t c) {
    const Chunk& chunk = chunks_[c];
    Elements& body = *bodies_[chunk.body];
    kernels_.strain(data(body), scratch(), dt, chunk.first, chunk.last, results[c]);
  });
  audit_.kinetic = others.kinetic;
  for (auto& b : bodies_) {
    std::vector<double> kinetic((b->node_count + kChunkNodes - 1) / kChunkNodes);
    for_each(kinetic.size(), [&](std::size_t c) {
      const std::size_t last = std::min((c + 1) * kChunkNodes, b->node_count);
      for (std::size_t n = c * kChunkNodes; n < last; ++n) {
        double* node = b->node(n);
        for (std::size_t a = 0; a < static_cast<std::size_t>(dim_); ++a) {
          node[4 + a] += b->change(n)[a];
          node[a] += dt * node[4 + a];
          kinetic[c] += 0.5 * node[3] * node[4 + a] * node[4 + a];
        }
      }
    });
    for (const double energy : kinetic) audit_.kinetic += energy;
  }
  find_limit(results);  // or the fault
  book(results, others);
  if (erode()) find_forces();  // and the limit without what is gone
  audit_.contact_pairs = others.contact_pairs;
  return {audit_.kinetic, audit_.internal, audit_.unfelt, audit_.law_lead, audit_.contact_pairs};
}

std::vector<double> MeshStep::state(int s) const {
  const Elements& b = *bodies_[static_cast<std::size_t>(s)];
  std::vector<double> out(b.nodes.data(), b.nodes.data() + kNode * b.node_count);
  b.for_each_record([&out](const AlignedBuffer& from, std::size_t count) {
    out.insert(out.end(), from.data(), from.data() + count);
  });
  for (const auto part : Eroded::parts)
    if (b.erodes()) out.push_back(b.eroded.*part);
  return out;
}

bool MeshStep::set_state(int s, const std::vector<double>& state) {
  Elements& b = *bodies_[static_cast<std::size_t>(s)];
  if (state.size() != this->state(s).size()) return false;
  if (b.erodes()) find_again(b);
  ++shape_changes_;
  const double* from = state.data();
  std::copy_n(from, kNode * b.node_count, b.nodes.data());
  from += kNode * b.node_count;
  b.for_each_record([&from](AlignedBuffer& to, std::size_t count) {
    std::copy_n(from, count, to.data());
    from += count;
  });
  for (const auto part : Eroded::parts)
    if (b.erodes()) b.eroded.*part = *from++;
  return true;
}

const std::vector<std::array<std::int32_t, 2>>& MeshStep::surface(int s) const {
  const Elements& b = *bodies_[static_cast<std::size_t>(s)];
  if (b.surface.empty()) b.surface = surface_edges(faces_of(b));
  return b.surface;
}

void MeshStep::pad(int s) {
  Elements& b = *bodies_[static_cast<std::size_t>(s)];
  b.elements.pad(b.columns.mass);
}

std::size_t MeshStep::memory() const {
  std::size_t doubles = 0;
  for (const auto& b : bodies_)
    doubles += b->elements.capacity() + b->shares.size() + b->forces.size() + b->hourglass.size() +
               b->hourglass_energy.size() + b->remembered.size() + b->placed.size() +
               b->nodes.size() + b->changes.size() + b->corners.size() / 2;
  return 8 * doubles;
}

PointSet MeshStep::set(int s) const {
  const Elements& b = *bodies_[static_cast<std::size_t>(s)];
  return {b.made_of.body, &b.elements};
}
PointStore& MeshStep::change(int s) { return bodies_[static_cast<std::size_t>(s)]->elements; }
const Mesh& MeshStep::mesh(int s) const {
  return bodies_[static_cast<std::size_t>(s)]->made_of.mesh;
}
std::size_t MeshStep::node_count(int s) const {
  return bodies_[static_cast<std::size_t>(s)]->node_count;
}
Triple MeshStep::position(int s, std::size_t n) const {
  const double* node = bodies_[static_cast<std::size_t>(s)]->node(n);
  return {node[0], node[1], node[2]};
}
Triple MeshStep::velocity(int s, std::size_t n) const {
  const double* node = bodies_[static_cast<std::size_t>(s)]->node(n);
  return {node[4], node[5], node[6]};
}
double MeshStep::mass(int s, std::size_t n) const {
  return bodies_[static_cast<std::size_t>(s)]->node(n)[3];
}

}  // namespace krater
