// SPDX-License-Identifier: GPL-3.0-or-later
// Particles that may meet other bodies, and the nodes that they reach.
#include <algorithm>

#include "kinematics/sph/particles.hpp"
#include "krater/core/parallel.hpp"
#include "krater/kinematics/sph/sph_contact.hpp"

namespace krater {

namespace {

constexpr double kReach = 6;  // cells: a meeting node reads fillings 3 cells on, and these points 3
constexpr int kChunk = 128;   // particles

std::size_t chunk_count(int particles) {
  return static_cast<std::size_t>((particles + kChunk - 1) / kChunk);
}

/// visit(particle) for those of chunk c.
template <class Visit>
void in_chunk(std::size_t c, int particles, const Visit& visit) {
  const int first = kChunk * static_cast<int>(c);
  for (int i = first; i < std::min(first + kChunk, particles); ++i) visit(i);
}

}  // namespace

bool SphContact::earlier(const Entry& a, const Entry& b) {
  return a.key != b.key ? a.key < b.key : a.body < b.body;
}

SpaceBox SphContact::box_of_set(int s) const {
  const SphStep::Particles& b = parts_.particles.particles(s);
  std::vector<SpaceBox> parts(chunk_count(b.points.count()));
  for_each(parts.size(), [&](std::size_t c) {
    in_chunk(c, b.points.count(),
             [&](int i) { parts[c].hold(b.vector(b.columns.position, i, dim_)); });
  });
  SpaceBox out;
  for (const SpaceBox& part : parts) {
    out.hold(part.low);
    out.hold(part.high);
  }
  return out;
}

/// Of all bodies; what is not there has an empty one.
std::vector<SpaceBox> SphContact::boxes() const {
  std::vector<SpaceBox> out(set_of_body_.size());
  for (int s = 0; s < parts_.particles.set_count(); ++s)
    out[static_cast<std::size_t>(parts_.particles.set(s).body)] = box_of_set(s);
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

/// A block of a body of points, with what its points see.
SpaceBox SphContact::box_of(const BlockKey& key) const {
  const double edge = geometry_.h * edge_;
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

/// In the domain, and near one of some boxes.
bool SphContact::takes_part(const Triple& x, const std::vector<SpaceBox>& others) const {
  for (int a = 0; a < dim_; ++a) {
    const auto k = static_cast<std::size_t>(a);
    if (!(x[k] > geometry_.min[k] && x[k] < geometry_.upper(a))) return false;
  }
  SpaceBox here;
  here.hold(x);
  return std::any_of(others.begin(), others.end(),
                     [&](const SpaceBox& o) { return o.meets(here, kReach * geometry_.h); });
}

SphContact::Carrier SphContact::carrier_of(int s, int i) const {
  const SphStep::Particles& b = parts_.particles.particles(s);
  const Triple x = b.vector(b.columns.position, i, dim_);
  Carrier q{};
  q.set = s;
  q.particle = i;
  q.key = block_of(geometry_, x.data());
  q.mass = b.points.at(b.columns.mass, i);
  q.volume = q.mass / b.points.at(b.columns.density, i);
  q.weight[2][0] = 1;
  for (int a = 0; a < dim_; ++a) {
    const auto k = static_cast<std::size_t>(a);
    const double t = geometry_.knots(x[k], a), base = Support::base(t), f = t - base + 0.5;
    q.first[k] = static_cast<int>(base);
    q.weight[k][0] = 0.5 * (1.5 - f) * (1.5 - f);
    q.weight[k][1] = 0.75 - (f - 1) * (f - 1);
    q.weight[k][2] = 0.5 * (f - 0.5) * (f - 0.5);
  }
  return q;
}

/// The particles of a set that are near one of some boxes, in their order, and their blocks.
void SphContact::add_carriers(int s, const std::vector<SpaceBox>& others,
                              std::vector<Entry>& blocks) {
  const SphStep::Particles& b = parts_.particles.particles(s);
  const int count = b.points.count(), body = parts_.particles.set(s).body;
  struct Found {
    std::vector<int> particles;
    std::vector<Entry> blocks;
    std::size_t first = 0;  ///< carrier
  };
  std::vector<Found> parts(chunk_count(count));
  for_each(parts.size(), [&](std::size_t c) {
    in_chunk(c, count, [&](int i) {
      if (takes_part(b.vector(b.columns.position, i, dim_), others))
        parts[c].particles.push_back(i);
    });
  });
  std::size_t all = carriers_.size();
  for (Found& part : parts) {
    part.first = all;
    all += part.particles.size();
  }
  carriers_.resize(all);
  for_each(parts.size(), [&](std::size_t c) {
    Found& part = parts[c];
    for (std::size_t k = 0; k < part.particles.size(); ++k) {
      const Carrier q = carrier_of(s, part.particles[k]);
      if (part.blocks.empty() || part.blocks.back().key != q.key)
        part.blocks.push_back({q.key, body});
      carriers_[part.first + k] = q;
    }
  });
  for (const Found& part : parts)
    blocks.insert(blocks.end(), part.blocks.begin(), part.blocks.end());
}

/// False where no body is near particles of another.
bool SphContact::find_carriers() {
  carriers_.clear();
  const std::vector<SpaceBox> all = boxes();
  const double within = kReach * geometry_.h;
  std::vector<Entry> blocks;
  for (int s = 0; s < parts_.particles.set_count(); ++s) {
    const auto own = static_cast<std::size_t>(parts_.particles.set(s).body);
    std::vector<SpaceBox> others;
    for (std::size_t o = 0; o < all.size(); ++o)
      if (o != own && all[o].meets(all[own], within)) others.push_back(all[o]);
    if (!others.empty()) add_carriers(s, others, blocks);
  }
  if (carriers_.empty() && !meshes_) return false;
  for (const Patch& patch : parts_.grid.patches()) {
    bool near = meshes_ != nullptr;  // bodies of elements meet those of points here too
    for (std::size_t o = 0; o < all.size() && !near; ++o)
      near = set_of_body_[o] != kNone && all[o].meets(box_of(patch.key), within);
    if (near) blocks.push_back({patch.key, patch.body});
  }
  lay_out(std::move(blocks));
  for_carriers(
      [&](Carrier& q) { q.patch = nodes_.find_patch(q.key, parts_.particles.set(q.set).body); });
  list_reaching();
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

/// For every block of nodes the carriers that reach it, in their order: so a sum at a node is the
/// same whoever makes it.
void SphContact::list_reaching() {
  const auto visit_blocks = [&](const Carrier& q, const auto& visit) {
    int across = 0;  // axes along which it reaches the next block
    for (int a = 0; a < dim_; ++a) {
      const auto k = static_cast<std::size_t>(a);
      if (q.first[k] - edge_ * q.key.i[k] + Support::support > edge_) across |= 1 << a;
    }
    const Patch& patch = nodes_.patches()[static_cast<std::size_t>(q.patch)];
    for (int corner = 0; corner <= across; ++corner)
      if ((corner & ~across) == 0)
        visit(static_cast<std::size_t>(patch.links.node_blocks[static_cast<std::size_t>(corner)]));
  };
  first_reaching_.assign(nodes_.node_blocks().size() + 1, 0);
  for (const Carrier& q : carriers_)
    visit_blocks(q, [&](std::size_t block) { ++first_reaching_[block + 1]; });
  for (std::size_t b = 1; b < first_reaching_.size(); ++b)
    first_reaching_[b] += first_reaching_[b - 1];
  reaching_.resize(first_reaching_.back());
  std::vector<std::uint32_t> next(first_reaching_.begin(), first_reaching_.end() - 1);
  for (std::size_t c = 0; c < carriers_.size(); ++c)
    visit_blocks(carriers_[c], [&](std::size_t block) {
      reaching_[next[block]++] = static_cast<std::uint32_t>(c);
    });
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

}  // namespace krater
