// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/sph/sph_contact.hpp"

#include <algorithm>
#include <cmath>

#include "kinematics/sph/particles.hpp"
#include "krater/core/parallel.hpp"

namespace krater {

namespace {

constexpr int kPasses = 4;

std::vector<FieldId> own_fields(int count) {
  std::vector<FieldId> out;
  for (int b = 0; b < count; ++b) out.push_back(own_field(b));
  return out;
}

double dot3(const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

}  // namespace

SphContact::SphContact(const ContactOptions& options, std::vector<bool> fluids, const Parts& parts)
    : dim_{parts.grid.geometry().dimension},
      edge_{block_edge(dim_)},
      stride_{dim_ == 3 ? edge_ * edge_ : edge_, dim_ == 3 ? edge_ : 1, 1},
      geometry_{parts.grid.geometry()},
      parts_{parts},
      set_of_body_(static_cast<std::size_t>(options.fields), kNone),
      nodes_{parts.grid.geometry()},
      sides_{parts.grid.geometry(), parts.boundary.conditions()},
      contact_{parts.grid.geometry(), parts.boundary.conditions(), false, false, options} {
  std::vector<bool> ours(static_cast<std::size_t>(options.fields), false);
  for (int s = 0; s < parts.particles.set_count(); ++s) {
    const auto body = static_cast<std::size_t>(parts.particles.set(s).body);
    set_of_body_[body] = static_cast<std::size_t>(s);
    ours[body] = true;
  }
  nodes_.set_fields(own_fields(options.fields));
  contact_.set_fluids(std::move(fluids));
  contact_.only_pairs_with(std::move(ours));
  if (parts.impulses.any()) contact_.note_impulses();
}

SphContact::~SphContact() = default;

/// visit(place among all nodes, S) of the nodes of a carrier.
template <class Visit>
void SphContact::for_nodes(const Carrier& q, const Visit& visit) const {
  const Patch& patch = nodes_.patches()[static_cast<std::size_t>(q.patch)];
  int corner[3][3]{}, local[3][3]{};  // [axis][step]
  for (int a = 0; a < dim_; ++a)
    for (int step = 0; step < 3; ++step) {
      const auto k = static_cast<std::size_t>(a);
      const int l = q.first[k] + step - patch.key.i[k] * edge_;
      corner[a][step] = l >= edge_ ? 1 << a : 0;
      local[a][step] = l % edge_ * stride_[k];
    }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < (dim_ == 3 ? 3 : 1); ++k) {
        const int at = corner[0][i] | corner[1][j] | corner[2][k];
        const std::ptrdiff_t block = patch.links.node_blocks[static_cast<std::size_t>(at)];
        visit(block * kBlockNodes + local[0][i] + local[1][j] + local[2][k],
              q.weight[0][i] * q.weight[1][j] * q.weight[2][k]);
      }
}

/// The part of a carrier that a block of nodes gets.
void SphContact::add_to(const NodeBlock& block, const Carrier& q) const {
  int from[3] = {0, 0, 0}, to[3] = {1, 1, 1}, at = 0;
  for (int a = 0; a < dim_; ++a) {
    const auto k = static_cast<std::size_t>(a);
    const int first = q.first[k] - block.key.i[k] * edge_;
    from[a] = std::max(0, -first);
    to[a] = std::min(3, edge_ - first);
    at += first * stride_[k];
  }
  for (int i = from[0]; i < to[0]; ++i)
    for (int j = from[1]; j < to[1]; ++j)
      for (int k = from[2]; k < to[2]; ++k) {
        const double w = q.weight[0][i] * q.weight[1][j] * q.weight[2][k];
        double* node =
            block.nodes + kNodeDoubles * (at + i * stride_[0] + j * stride_[1] + k * stride_[2]);
        node[summed::mass] += w * q.mass;
        for (std::size_t a = 0; a < static_cast<std::size_t>(dim_); ++a)
          node[summed::momentum + a] += w * q.momentum[a];
        node[summed::volume] += w * q.volume;
      }
}

/// Nodes of particles: [v, m, 0, V] of their motion so far.
void SphContact::fill() {
  for_carriers([&](Carrier& q) {
    SphStep::Particles& b = parts_.particles.particles(q.set);
    const double* change = b.change(q.particle);
    const Triple v = b.vector(b.columns.velocity, q.particle, dim_);
    for (std::size_t a = 0; a < 3; ++a) q.momentum[a] = q.mass * (v[a] + change[a]);
  });
  for_each(nodes_.node_blocks().size(), [&](std::size_t n) {
    const NodeBlock& block = nodes_.node_blocks()[n];
    std::fill_n(block.nodes, kBlockNodes * kNodeDoubles, 0.0);
    for (std::uint32_t c = first_reaching_[n]; c < first_reaching_[n + 1]; ++c)
      add_to(block, carriers_[reaching_[c]]);
  });
  sides_.fold();
  for_each(nodes_.node_blocks().size(), [&](std::size_t n) {
    for (int k = 0; k < kBlockNodes; ++k) {
      double* node = nodes_.node_blocks()[n].nodes + kNodeDoubles * k;
      const double m = node[summed::mass], per = m > 0 ? 1 / m : 0.0;
      const Triple v{per * node[summed::momentum], per * node[summed::momentum + 1],
                     per * node[summed::momentum + 2]};
      std::copy_n(v.data(), 3, node + moved::velocity);
      node[moved::mass] = m;
      std::fill_n(node + moved::change, 3, 0.0);
    }
  });
}

/// Nodes of bodies of points, as they are on their own grid by now.
void SphContact::show_points() {
  for_each(shared_.size(), [&](std::size_t n) {
    std::copy_n(parts_.grid.node_blocks()[shared_[n].there].nodes, kBlockNodes * kNodeDoubles,
                nodes_.node_blocks()[shared_[n].here].nodes);
  });
}

/// What nodes of points were pushed by, to their own grid.
void SphContact::take_pushes() {
  for_each(shared_.size(), [&](std::size_t k) {
    Shared& s = shared_[k];
    NodeBlock& there = parts_.grid.node_blocks()[s.there];
    const double* here = nodes_.node_blocks()[s.here].nodes;
    for (std::size_t n = 0; n < kBlockNodes; ++n) {
      const double* from = here + kNodeDoubles * n;
      double* to = there.nodes + kNodeDoubles * n;
      bool pushed = false;
      for (std::size_t a = 0; a < 3; ++a) {
        const double dv = from[moved::change + a] - to[moved::change + a];
        pushed = pushed || dv != 0;
        s.impulse[n][a] += to[moved::mass] * dv;
      }
      if (!pushed) continue;
      s.mass[n] = to[moved::mass];
      std::copy_n(from + moved::velocity, 3, to + moved::velocity);
      std::copy_n(from + moved::change, 3, to + moved::change);
      there.still = there.inert = false;
    }
  });
}

void SphContact::give_back() {
  for (const NodeBlock& block : nodes_.node_blocks()) {
    if (set_of_body_[static_cast<std::size_t>(body_of(block.field))] == kNone) continue;
    for (std::size_t n = 0; n < kBlockNodes; ++n)
      for (std::size_t a = 0; a < 3; ++a)
        given_[a] += block.nodes[kNodeDoubles * n + moved::mass] *
                     block.nodes[kNodeDoubles * n + moved::change + a];
  }
  sides_.mirror();
  const double* nodes = nodes_.nodes();
  for_carriers([&](Carrier& q) {
    Triple dv{};
    for_nodes(q, [&](std::ptrdiff_t node, double w) {
      const double* at = nodes + kNodeDoubles * node + moved::change;
      for (std::size_t a = 0; a < static_cast<std::size_t>(dim_); ++a) dv[a] += w * at[a];
    });
    double* change = parts_.particles.particles(q.set).change(q.particle);
    for (std::size_t a = 0; a < 3; ++a) {
      change[a] += dv[a];
      q.by_contact[a] += dv[a];
    }
  });
}

void SphContact::book_rigid(const ContactWork& work, double kinetic) {
  rigid_work_ += parts_.rigid.kinetic() - kinetic - work.driven;
  parts_.audit.external_work += work.driven;
  for (std::size_t a = 0; a < 3; ++a) {
    parts_.audit.external_impulse[a] += work.driven_impulse[a];
    parts_.audit.wall_impulse[a] += work.held_impulse[a];
  }
}

void SphContact::push(double dt) {
  friction_ = pairs_ = rigid_work_ = 0;
  given_ = {};
  any_ = find_carriers();
  if (!any_) return;
  share_blocks();
  fill();
  show_points();
  if (meshes_) meshes_->begin();
  for (int k = 0; k < kPasses; ++k) {
    if (k > 0) {
      fill();
      show_points();
    }
    const double kinetic = parts_.rigid.kinetic();
    const ContactWork work = contact_.apply(nodes_, {}, parts_.rigid);
    contact_.give(parts_.impulses);
    book_rigid(work, kinetic);
    friction_ += work.friction;
    pairs_ = std::max(pairs_, work.nodes);
    if (meshes_) meshes_->pass(dt);
    take_pushes();
    give_back();
  }
  if (meshes_) meshes_->end();
}

/// What contact took from the motion of particles and nodes of points, and sum m |dv|^2.
EncounterLoss SphContact::loss() {
  EncounterLoss out{-rigid_work_, 0};
  for_carriers([&](Carrier& q) {
    SphStep::Particles& b = parts_.particles.particles(q.set);
    const double* change = b.change(q.particle);
    Triple mean = b.vector(b.columns.velocity, q.particle, dim_);
    for (std::size_t a = 0; a < 3; ++a) mean[a] += 0.5 * change[a];
    q.loss = {-q.mass * dot3(q.by_contact, mean), q.mass * dot3(q.by_contact, q.by_contact)};
  });
  for (const Carrier& q : carriers_) {
    out.taken += q.loss.taken;
    out.pushed += q.loss.pushed;
  }
  for (const Shared& s : shared_)
    for (std::size_t n = 0; n < kBlockNodes; ++n) {
      const Triple& J = s.impulse[n];
      if (J == Triple{}) continue;
      const double* node = parts_.grid.node_blocks()[s.there].nodes + kNodeDoubles * n;
      for (std::size_t a = 0; a < 3; ++a)
        out.taken -= J[a] * (node[moved::velocity + a] - 0.5 * node[moved::change + a]);
      out.pushed += dot3(J, J) / s.mass[n];
    }
  return out;
}

/// It becomes heat of what was pushed, by m |dv|^2.
Standing SphContact::book() {
  if (!any_) return {};
  EncounterLoss all = loss();
  if (meshes_) {
    const EncounterLoss more = meshes_->loss();
    all.taken += more.taken;
    all.pushed += more.pushed;
  }
  Standing out = meshes_ ? meshes_->warm(all) : Standing{};
  out.contact_pairs += pairs_;
  if (!(all.pushed > 0)) return out;
  for_carriers([&](Carrier& q) {
    parts_.particles.particles(q.set).change(q.particle)[3] +=
        all.share() * dot3(q.by_contact, q.by_contact);
  });
  double in_points = 0;
  for (const Shared& s : shared_)
    for (std::size_t n = 0; n < kBlockNodes; ++n) {
      if (s.impulse[n] == Triple{}) continue;
      double* node = parts_.grid.node_blocks()[s.there].nodes + kNodeDoubles * n;
      const double m = s.mass[n], heat = all.share() * dot3(s.impulse[n], s.impulse[n]) / m;
      node[moved::work] += heat / m;
      in_points += heat;
    }
  if (in_points != 0) parts_.boundary.mirror_work();
  parts_.audit.contact_heat += all.taken;
  parts_.audit.transfer_loss -= in_points;  // MPM's own account takes it for that
  parts_.audit.friction_work += friction_;
  // What a plane of symmetry gave particles is what contact did not (SphStep::meet).
  for (std::size_t a = 0; a < static_cast<std::size_t>(dim_); ++a)
    if (parts_.boundary.conditions()[a][0].kind == BoundaryKind::symmetry ||
        parts_.boundary.conditions()[a][1].kind == BoundaryKind::symmetry)
      parts_.audit.wall_impulse[a] -= given_[a];
  return out;
}

}  // namespace krater
