// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/sph/sph_contact.hpp"

#include <algorithm>
#include <cmath>

#include "kinematics/sph/particles.hpp"

namespace krater {

namespace {

constexpr int kPasses = 4;
constexpr double kReach = 6;  // cells: a meeting node reads fillings 3 cells on, and these points 3
constexpr std::size_t kNone = ~std::size_t{0};

std::vector<FieldId> own_fields(int count) {
  std::vector<FieldId> out;
  for (int b = 0; b < count; ++b) out.push_back(own_field(b));
  return out;
}

double dot3(const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

}  // namespace

SphContact::SphContact(const ContactOptions& options, std::vector<bool> fluids, const Parts& parts)
    : dim_{parts.grid.geometry().dimension},
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

bool SphContact::earlier(const Entry& a, const Entry& b) {
  return a.key != b.key ? a.key < b.key : a.body < b.body;
}

/// Of all bodies; what is not there has an empty one.
std::vector<SpaceBox> SphContact::boxes() {
  std::vector<SpaceBox> out(set_of_body_.size());
  for (int s = 0; s < parts_.particles.set_count(); ++s) {
    const SphStep::Particles& b = parts_.particles.particles(s);
    SpaceBox& box = out[static_cast<std::size_t>(b.made_of.body)];
    for (int i = 0; i < b.points.count(); ++i) box.hold(b.vector(b.columns.position, i, dim_));
  }
  for (const Patch& patch : parts_.grid.patches()) {
    const SpaceBox box = box_of(patch.key);
    out[static_cast<std::size_t>(patch.body)].hold(box.low);
    out[static_cast<std::size_t>(patch.body)].hold(box.high);
  }
  if (meshes_)
    for (const BodyBox& of : meshes_->boxes())  // beside the points that its elements became
      if (of.box.low[0] <= of.box.high[0]) {
        out[static_cast<std::size_t>(of.body)].hold(of.box.low);
        out[static_cast<std::size_t>(of.body)].hold(of.box.high);
      }
  return out;
}

void SphContact::place(Carrier& q, const Triple& x) const {
  for (int a = 0; a < dim_; ++a) {
    const auto k = static_cast<std::size_t>(a);
    const double t = geometry_.knots(x[k], a), base = Support::base(t), f = t - base + 0.5;
    q.first[k] = static_cast<int>(base);
    q.weight[k][0] = 0.5 * (1.5 - f) * (1.5 - f);
    q.weight[k][1] = 0.75 - (f - 1) * (f - 1);
    q.weight[k][2] = 0.5 * (f - 0.5) * (f - 0.5);
  }
}

/// A block of a body of points, with what its points see.
SpaceBox SphContact::box_of(const BlockKey& key) const {
  const double edge = geometry_.h * block_edge(dim_);
  Triple low{}, high{};
  for (std::size_t a = 0; a < static_cast<std::size_t>(dim_); ++a) {
    low[a] = geometry_.min[a] + edge * key.i[a] - geometry_.h;
    high[a] = low[a] + edge + 2 * geometry_.h;
  }
  SpaceBox out;
  out.hold(low);
  out.hold(high);
  return out;
}

/// The particles of a set that are near one of some boxes.
void SphContact::add_carriers(int s, const std::vector<SpaceBox>& others) {
  const SphStep::Particles& b = parts_.particles.particles(s);
  for (int i = 0; i < b.points.count(); ++i) {
    const Triple x = b.vector(b.columns.position, i, dim_);
    bool inside = true;
    for (int a = 0; a < dim_; ++a) {
      const auto k = static_cast<std::size_t>(a);
      inside = inside && x[k] > geometry_.min[k] && x[k] < geometry_.upper(a);
    }
    SpaceBox here;
    here.hold(x);
    if (!inside || std::none_of(others.begin(), others.end(), [&](const SpaceBox& o) {
          return o.meets(here, kReach * geometry_.h);
        }))
      continue;
    Carrier q{};
    q.set = static_cast<std::size_t>(s);
    q.particle = i;
    q.key = block_of(geometry_, x.data());
    q.mass = b.points.at(b.columns.mass, i);
    q.volume = q.mass / b.points.at(b.columns.density, i);
    place(q, x);
    carriers_.push_back(q);
  }
}

/// False where no body is near particles of another.
bool SphContact::find_carriers() {
  carriers_.clear();
  const std::vector<SpaceBox> all = boxes();
  const double within = kReach * geometry_.h;
  for (int s = 0; s < parts_.particles.set_count(); ++s) {
    const auto own = static_cast<std::size_t>(parts_.particles.set(s).body);
    std::vector<SpaceBox> others;
    for (std::size_t o = 0; o < all.size(); ++o)
      if (o != own && all[o].meets(all[own], within)) others.push_back(all[o]);
    if (!others.empty()) add_carriers(s, others);
  }
  if (carriers_.empty() && !meshes_) return false;
  const auto body_of_set = [&](std::size_t s) {
    return parts_.particles.set(static_cast<int>(s)).body;
  };
  std::vector<Entry> list;
  for (const Carrier& q : carriers_)
    if (list.empty() || !(list.back() == Entry{q.key, body_of_set(q.set)}))
      list.push_back({q.key, body_of_set(q.set)});
  for (const Patch& patch : parts_.grid.patches()) {
    bool near = meshes_ != nullptr;  // bodies of elements meet those of points here too
    for (std::size_t o = 0; o < all.size() && !near; ++o)
      near = set_of_body_[o] != kNone && all[o].meets(box_of(patch.key), within);
    if (near) list.push_back({patch.key, patch.body});
  }
  lay_out(std::move(list));
  for (Carrier& q : carriers_) q.patch = nodes_.find_patch(q.key, body_of_set(q.set));
  return true;
}

/// Blocks of nodes, where they are not as in the step before.
void SphContact::lay_out(std::vector<Entry> entries) {
  std::sort(entries.begin(), entries.end(), earlier);
  entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
  if (entries == entries_) return;
  entries_ = std::move(entries);
  nodes_.drop_patches();
  for (const Entry& e : entries_) nodes_.add_patch(e.key, e.body, kLanes);
  nodes_.rebuild(false);
  sides_.relink(nodes_);
  contact_.relink(nodes_);
}

/// Blocks that bodies of points have on their own grid.
void SphContact::share_blocks() {
  shared_.clear();
  for (std::size_t n = 0; n < nodes_.node_blocks().size(); ++n) {
    const NodeBlock& block = nodes_.node_blocks()[n];
    if (set_of_body_[static_cast<std::size_t>(body_of(block.field))] != kNone) continue;
    const int there = parts_.grid.find_node_block(block.key, block.field);
    if (there >= 0) shared_.push_back({n, static_cast<std::size_t>(there), {}, {}});
  }
}

template <class Visit>
void SphContact::for_nodes(const Carrier& q, const Visit& visit) {
  const int edge = block_edge(dim_);
  const Patch& patch = nodes_.patches()[static_cast<std::size_t>(q.patch)];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < (dim_ == 3 ? 3 : 1); ++k) {
        const int step[3] = {i, j, k};
        int corner = 0, local = 0;
        double w = 1;
        for (int a = 0; a < dim_; ++a) {
          const auto c = static_cast<std::size_t>(a);
          int l = q.first[c] + step[a] - patch.key.i[c] * edge;
          if (l >= edge) {
            l -= edge;
            corner |= 1 << a;
          }
          local = local * edge + l;
          w *= q.weight[a][step[a]];
        }
        const int block = patch.links.node_blocks[static_cast<std::size_t>(corner)];
        visit(nodes_.nodes() +
                  kNodeDoubles * (static_cast<std::ptrdiff_t>(block) * kBlockNodes + local),
              w);
      }
}

/// Nodes of particles: [v, m, 0, V] of their motion so far.
void SphContact::fill() {
  const std::size_t all = nodes_.node_blocks().size() * kBlockNodes;
  std::fill_n(nodes_.nodes(), all * kNodeDoubles, 0.0);
  for (const Carrier& q : carriers_) {
    SphStep::Particles& b = parts_.particles.particles(static_cast<int>(q.set));
    const double* change = b.change(q.particle);
    Triple p = b.vector(b.columns.velocity, q.particle, dim_);
    for (std::size_t a = 0; a < 3; ++a) p[a] = q.mass * (p[a] + change[a]);
    for_nodes(q, [&](double* node, double w) {
      node[summed::mass] += w * q.mass;
      for (std::size_t a = 0; a < static_cast<std::size_t>(dim_); ++a)
        node[summed::momentum + a] += w * p[a];
      node[summed::volume] += w * q.volume;
    });
  }
  sides_.fold();
  for (double* node = nodes_.nodes(); node < nodes_.nodes() + all * kNodeDoubles;
       node += kNodeDoubles) {
    const double m = node[summed::mass], per = m > 0 ? 1 / m : 0.0;
    const Triple v{per * node[summed::momentum], per * node[summed::momentum + 1],
                   per * node[summed::momentum + 2]};
    std::copy_n(v.data(), 3, node + moved::velocity);
    node[moved::mass] = m;
    std::fill_n(node + moved::change, 3, 0.0);
  }
}

/// Nodes of bodies of points, as they are on their own grid by now.
void SphContact::show_points() {
  for (const Shared& s : shared_)
    std::copy_n(parts_.grid.node_blocks()[s.there].nodes, kBlockNodes * kNodeDoubles,
                nodes_.node_blocks()[s.here].nodes);
}

/// What nodes of points were pushed by, to their own grid.
void SphContact::take_pushes() {
  for (Shared& s : shared_) {
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
  }
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
  for (Carrier& q : carriers_) {
    Triple dv{};
    for_nodes(q, [&](const double* node, double w) {
      for (std::size_t a = 0; a < static_cast<std::size_t>(dim_); ++a)
        dv[a] += w * node[moved::change + a];
    });
    double* change = parts_.particles.particles(static_cast<int>(q.set)).change(q.particle);
    for (std::size_t a = 0; a < 3; ++a) {
      change[a] += dv[a];
      q.by_contact[a] += dv[a];
    }
  }
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
EncounterLoss SphContact::loss() const {
  EncounterLoss out{-rigid_work_, 0};
  for (const Carrier& q : carriers_) {
    SphStep::Particles& b = parts_.particles.particles(static_cast<int>(q.set));
    const double* change = b.change(q.particle);
    Triple mean = b.vector(b.columns.velocity, q.particle, dim_);
    for (std::size_t a = 0; a < 3; ++a) mean[a] += 0.5 * change[a];
    out.taken -= q.mass * dot3(q.by_contact, mean);
    out.pushed += q.mass * dot3(q.by_contact, q.by_contact);
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
  for (const Carrier& q : carriers_)
    parts_.particles.particles(static_cast<int>(q.set)).change(q.particle)[3] +=
        all.share() * dot3(q.by_contact, q.by_contact);
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
