// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/contact/contact.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "krater/contact/contact_regression.hpp"
#include "krater/core/parallel.hpp"

namespace krater {

namespace {

constexpr int kSweeps = 3;

double square(const double* v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

void push(double* node, const std::array<double, 3>& impulse) {
  const double inverse = 1 / node[moved::mass];
  for (int a = 0; a < 3; ++a) {
    const double change = impulse[static_cast<unsigned>(a)] * inverse;
    node[a] += change;
    node[moved::change + a] += change;
  }
}

}  // namespace

ContactSet::ContactSet(const GridGeometry& geometry, const BoundaryConditions& conditions,
                       bool hoop, bool linear, const ContactOptions& options)
    : geometry_{geometry},
      conditions_{conditions},
      hoop_{hoop},
      linear_{linear},
      options_{options},
      edge_{block_edge(geometry.dimension)},
      padded_{edge_ + 2 * halo()},
      size_{geometry.dimension == 3 ? padded_ * padded_ * padded_ : padded_ * padded_} {
  for (int a = geometry.dimension - 1, s = 1; a >= 0; --a, s *= padded_) stride_[a] = s;
}

/// Part of the shape function's volume, along one axis, that lies in the domain; about the axis of
/// symmetry times the circumference [1 or m].
double ContactSet::covered(const GridGeometry& g, int axis, int index) const {
  const auto& sides = conditions_[static_cast<unsigned>(axis)];
  const bool low = sides[0].mirrors(axis), high = sides[1].mirrors(axis);
  const double first = g.lower_storage(), last = g.upper_storage(axis);
  if (g.planes_on_knots()) {
    // The first node, half a cell inside, has its ghost's part where that is folded; what a wall
    // leaves with the ghost is a sixth.
    const bool at_low = low && index == first + 0.5, at_high = high && index == last - 0.5;
    const bool whole = (!at_low || sides[0].folds()) && (!at_high || sides[1].folds());
    const double part = whole ? 1 : 5.0 / 6;
    if (!hoop_ || axis != 0) return part;
    double radius = g.place(index, 0);
    if (at_low) radius = g.min[0] + 7.0 / 12 * g.h;
    if (at_high) radius = g.upper(0) - 7.0 / 12 * g.h;
    return part * 2 * std::numbers::pi * radius;
  }
  const bool cut = (low && index == 1) || (high && index == last);
  if (!hoop_ || axis != 0) return cut ? 0.5 : 1.0;
  // int S r dr over r > 0, with the ghost's part folded: B-spline 13/64 and 1 + 1/192 at the first
  // nodes of an axis at r = 0.
  const double h = g.h, r = g.min[0] + (index - 1) * h;
  double radius = cut ? 0.5 * r : r;
  if (low && g.min[0] <= 0 && index == 1) radius = (linear_ ? 1.0 / 6 : 13.0 / 64) * h;
  if (low && g.min[0] <= 0 && index == 2) radius = (linear_ ? 1 : 193.0 / 192) * h;
  return 2 * std::numbers::pi * radius;
}

int ContactSet::mirrored(const GridGeometry& g, int axis, int index) const {
  const auto& sides = conditions_[static_cast<unsigned>(axis)];
  const double first = g.lower_storage(), last = g.upper_storage(axis);
  if (sides[0].mirrors(axis) && index < first) return static_cast<int>(2 * first) - index;
  if (sides[1].mirrors(axis) && index > last) return static_cast<int>(2 * last) - index;
  return index;
}

double ContactSet::whole_volume(const GridGeometry& g, const std::array<int, 3>& index) const {
  double part = 1;
  for (int a = 0; a < g.dimension; ++a) {
    const int inside = mirrored(g, a, index[static_cast<unsigned>(a)]);
    part *= g.h * covered(g, a, inside);
  }
  return part;
}

void ContactSet::relink(const BlockGrid& grid) {
  std::vector<Group> before;  // their memory is used again
  before.swap(groups_);
  geometries_.clear();
  for (int level = 0; level < grid.levels().count(); ++level)
    geometries_.push_back(grid.geometry(level));
  if (!options_.active) return;
  const std::vector<NodeBlock>& blocks = grid.node_blocks();
  for (std::size_t n = 0; n < blocks.size();) {
    std::size_t end = n + 1;
    while (end < blocks.size() && blocks[end].key == blocks[n].key) ++end;
    if (end - n > 1) {
      Group& group = groups_.emplace_back();
      if (!before.empty()) {
        group = std::move(before.back());
        before.pop_back();
      }
      group.first = n;
      group.fields = static_cast<int>(end - n);
      group.counted = blocks[n].counted;
      group.sources.clear();
      group.begin_step();
    }
    n = end;
  }
  results_.resize(groups_.size());
  scratch_.resize(static_cast<std::size_t>(std::max(threads(), 1)));
}

ContactWork ContactSet::apply(BlockGrid& grid, const std::vector<PointColumns>& columns,
                              RigidBodies& rigid, bool projection) {
  for_each(groups_.size(), [&](std::size_t g) {
    find_contacts(grid, columns, groups_[g], scratch_[static_cast<unsigned>(thread_index())],
                  rigid);
  });
  if (rigid.any()) foretell(grid, rigid);
  for_each(groups_.size(),
           [&](std::size_t g) { results_[g] = exchange_group(grid, groups_[g], rigid); });
  ContactWork sum = total();
  if (!projection) hand_over(rigid, sum);
  return sum;
}

ContactSet::AxisLinks ContactSet::axis_links(const BlockKey& key) const {
  AxisLinks links;
  const GridGeometry& g = geometry(key.level);
  for (int a = 0; a < geometry_.dimension; ++a)
    for (int i = 0; i < padded_; ++i) {
      const int origin = key.i[static_cast<unsigned>(a)] * edge_;
      const int index = mirrored(g, a, origin + i - halo());
      const int offset = index < origin ? -1 : (index >= origin + edge_ ? 1 : 0);
      AxisLink& link = links[static_cast<unsigned>(a)][static_cast<unsigned>(i)];
      const double part = g.h * covered(g, a, index);
      link = {offset + 1, index - origin - offset * edge_, part > 0 ? 1 / part : 0};
    }
  return links;
}

void ContactSet::link(const BlockGrid& grid, Group& group) const {
  const int dimension = geometry_.dimension, slots = neighbour_count(dimension);
  const NodeBlock& home = grid.node_blocks()[group.first];
  std::vector<int> around;
  for (int f = 0; f < group.fields; ++f)
    for (int slot = 0; slot < slots; ++slot)
      around.push_back(grid.find_node_block(
          shifted(home.key, slot, dimension),
          grid.node_blocks()[group.first + static_cast<std::size_t>(f)].field));
  const AxisLinks links = axis_links(home.key);
  group.sources.resize(static_cast<std::size_t>(size_ * group.fields));
  group.inverse.resize(static_cast<std::size_t>(size_));
  const int last = dimension - 1;
  for (int row = 0; row < size_; row += padded_) {
    int slot = 0, local = 0;
    double inverse = 1;
    for (int a = 0; a < last; ++a) {
      const AxisLink& link =
          links[static_cast<unsigned>(a)][static_cast<unsigned>(row / stride_[a] % padded_)];
      slot = 3 * slot + link.slot;
      local = local * edge_ + link.local;
      inverse *= link.inverse;
    }
    for (int i = 0; i < padded_; ++i) {
      const AxisLink& link = links[static_cast<unsigned>(last)][static_cast<unsigned>(i)];
      const int at = local * edge_ + link.local, from = 3 * slot + link.slot;
      group.inverse[static_cast<std::size_t>(row + i)] = inverse * link.inverse;
      for (int f = 0; f < group.fields; ++f) {
        const int block = around[static_cast<std::size_t>(f * slots + from)];
        group.sources[static_cast<std::size_t>(f * size_ + row + i)] =
            block < 0 ? -1 : block * kBlockNodes + at;
      }
    }
  }
}

void ContactSet::fill(const BlockGrid& grid, const Group& group, Scratch& scratch) const {
  const double* nodes = grid.nodes();  // node memory is contiguous over blocks
  scratch.filling.resize(group.sources.size());
  scratch.slopes.resize(std::max(scratch.slopes.size(), group.sources.size()));
  ++scratch.fillings;
  for (int f = 0; f < group.fields; ++f)
    for (int n = 0; n < size_; ++n) {
      const auto i = static_cast<std::size_t>(f * size_ + n);
      const std::int32_t from = group.sources[i];
      scratch.filling[i] = from < 0 ? 0.0
                                    : group.inverse[static_cast<std::size_t>(n)] *
                                          nodes[kNodeDoubles * from + moved::volume];
    }
}

double ContactSet::filling(const BlockGrid& grid, const std::array<int, 3>& index,
                           FieldId field) const {
  std::array<int, 3> inside{};
  for (int a = 0; a < geometry_.dimension; ++a)
    inside[static_cast<unsigned>(a)] = mirrored(geometry_, a, index[static_cast<unsigned>(a)]);
  const double part = whole_volume(geometry_, inside);
  const double* node = grid.find_node(inside, field);
  return node != nullptr && part > 0 ? node[moved::volume] / part : 0.0;
}

Triple ContactSet::exchange(double* a, double* b, const Contact& contact, double mu,
                            ContactWork& sum) const {
  const double reduced = a[moved::mass] * b[moved::mass] / (a[moved::mass] + b[moved::mass]);
  Triple apart{}, impulse{};
  double closing = 0;
  for (unsigned i = 0; i < 3; ++i) {
    apart[i] = a[i] - b[i];
    closing += apart[i] * contact.normal[i];
  }
  if (!(closing > 0)) return {};
  double slip = 0;
  for (unsigned i = 0; i < 3; ++i) {
    apart[i] -= closing * contact.normal[i];
    slip += apart[i] * apart[i];
  }
  slip = std::sqrt(slip);
  const double loss = slip > 0 ? std::min(mu * closing / slip, 1.0) : 0.0;
  for (unsigned i = 0; i < 3; ++i)
    impulse[i] = -reduced * (closing * contact.normal[i] + loss * apart[i]);
  sum.change -= 0.5 * (a[moved::mass] * square(a) + b[moved::mass] * square(b));
  push(a, impulse);
  push(b, {-impulse[0], -impulse[1], -impulse[2]});
  sum.change += 0.5 * (a[moved::mass] * square(a) + b[moved::mass] * square(b));
  sum.friction -= reduced * slip * slip * loss * (1 - 0.5 * loss);
  sum.nodes += 1;
  return impulse;
}

/// A plane that mirrors has taken the odd components of momenta and forces from its nodes; an
/// impulse must not bring them back. False: nothing is left to push along.
bool ContactSet::keep_in_planes(const BlockKey& key, Contact& contact) const {
  if (geometry(key.level).planes_on_knots()) return true;  // no node lies on them
  const std::array<int, 3> index = index_in(key, contact.node, geometry_.dimension);
  for (unsigned axis = 0; axis < static_cast<unsigned>(geometry_.dimension); ++axis) {
    for (std::size_t side = 0; side < 2; ++side) {
      if (index[axis] != (side == 0 ? 1 : geometry_.cells[axis] + 1)) continue;
      const BoundaryKind kind = conditions_[axis][side].kind;
      if (kind == BoundaryKind::sticky) return false;
      if (kind == BoundaryKind::symmetry) contact.normal[axis] = 0;
    }
  }
  const double length = std::sqrt(square(contact.normal.data()));
  for (double& n : contact.normal) n /= length;
  return length > 0;
}

/// Normal from the points around the joint.
void ContactSet::refine(const BlockGrid& grid, const std::vector<PointColumns>& columns,
                        const Group& group, const Joint& joint, Contact& contact) const {
  const NodeBlock& home = grid.node_blocks()[group.first];
  std::array<double, 3> at{};
  for (int k = 0; k < joint.count; ++k)
    for (int a = geometry_.dimension - 1, rest = joint.nodes[static_cast<std::size_t>(k)]; a >= 0;
         --a, rest /= padded_) {
      const auto i = static_cast<unsigned>(a);
      const int index = mirrored(geometry_, a, home.key.i[i] * edge_ + rest % padded_ - halo());
      at[i] += (geometry_.min[i] + (index - 1) * geometry_.h) / joint.count;
    }
  const auto body = [&](int f) {
    return body_of(grid.node_blocks()[group.first + static_cast<std::size_t>(f)].field);
  };
  regress_normal(grid, columns, body(contact.a), body(contact.b), at, contact.normal);
}

void ContactSet::find_contacts(const BlockGrid& grid, const std::vector<PointColumns>& columns,
                               Group& group, Scratch& scratch, const RigidBodies& rigid) const {
  group.begin_step();
  bool filled = false;
  const auto place_of = [this](int n) {  // among the nodes of the block and around it
    const std::array<int, 3> local = index_in({}, n, geometry_.dimension);
    int at = 0;
    for (int a = 0; a < geometry_.dimension; ++a)
      at += (local[static_cast<unsigned>(a)] + halo()) * stride_[a];
    return at;
  };
  const auto block = [&](int f) -> const NodeBlock& {
    return grid.node_blocks()[group.first + static_cast<std::size_t>(f)];
  };
  for (int n = 0; n < kBlockNodes; ++n) {
    const auto mass = [&](int f) { return block(f).nodes[kNodeDoubles * n + moved::mass]; };
    for (int a = 0; a < group.fields; ++a)
      for (int b = a + 1; b < group.fields && mass(a) > 0; ++b) {
        if (!(mass(b) > 0)) continue;
        if (!may_meet(body_of(block(a).field), body_of(block(b).field))) continue;
        const std::array stiff{rigid.find(body_of(block(a).field)) != nullptr,
                               rigid.find(body_of(block(b).field)) != nullptr};
        if (stiff[0] && stiff[1]) continue;
        if (group.sources.empty()) link(grid, group);
        if (!filled) fill(grid, group, scratch);
        filled = true;
        const std::array fluid{is_fluid(body_of(block(a).field)),
                               is_fluid(body_of(block(b).field))};
        const int at = place_of(n);
        Contact contact{n, a, b, {}, false, fluid, stiff};
        if (!find_contact(scratch, at, contact)) continue;
        if (contact.even && options_.normal == ContactNormal::logistic_regression)
          refine(grid, columns, group, joint_of(scratch, at, contact), contact);
        if (block(a).at_boundary && !keep_in_planes(block(a).key, contact)) continue;
        group.contacts.push_back(contact);
      }
  }
}

// All pairs of one node, and what they changed of each field.
template <class Touch>
void ContactSet::exchange_node(BlockGrid& grid, Group& group, std::size_t first, std::size_t end,
                               const Touch& touch) const {
  std::vector<Before>& fields = scratch_[static_cast<unsigned>(thread_index())].before;
  fields.clear();
  for (std::size_t c = first; c < end; ++c) {
    const Contact& contact = group.contacts[c];
    for (const int f : {contact.a, contact.b}) {
      double* node = grid.node_blocks()[group.first + static_cast<std::size_t>(f)].nodes +
                     kNodeDoubles * contact.node;
      if (std::none_of(fields.begin(), fields.end(),
                       [node](const Before& b) { return b.node == node; }))
        fields.push_back({node, {node[0], node[1], node[2]}});
    }
  }
  for (int sweep = 0; sweep < (end - first > 1 ? kSweeps : 1); ++sweep)
    for (std::size_t c = first; c < end; ++c) touch(group.contacts[c]);
  bool any = false;
  for (const Before& b : fields) {
    std::array<double, 3> change{};
    for (unsigned a = 0; a < 3; ++a) change[a] = b.node[a] - b.velocity[a];
    if (square(change.data()) == 0) continue;  // not pushed, or rigid
    group.heat.add(b.node, b.node[moved::mass], change);
    any = true;
  }
  any =
      any || (!group.rigid_pushes.empty() && group.rigid_pushes.back().loss == group.heat.count());
  if (any) group.heat.close();
}

ContactWork ContactSet::exchange_group(BlockGrid& grid, Group& group,
                                       const RigidBodies& rigid) const {
  ContactWork sum;
  const auto block = [&](int f) -> NodeBlock& {
    return grid.node_blocks()[group.first + static_cast<std::size_t>(f)];
  };
  const auto touch = [&](const Contact& c) {  // returns the impulse on a, or on what is not rigid
    const bool a_is_rigid = rigid.find(body_of(block(c.a).field)) != nullptr;
    if (a_is_rigid || rigid.find(body_of(block(c.b).field))) {
      const Strike strike = strike_of(grid, group, c, a_is_rigid);
      return exchange(strike, twists_[static_cast<std::size_t>(strike.body)], group, sum);
    }
    return exchange(
        block(c.a).nodes + kNodeDoubles * c.node, block(c.b).nodes + kNodeDoubles * c.node, c,
        options_.friction_of(body_of(block(c.a).field), body_of(block(c.b).field)), sum);
  };
  const auto noted = [&](const Contact& c) {
    const FieldId a = block(c.a).field, b = block(c.b).field;
    const bool a_is_rigid = rigid.find(body_of(a)) != nullptr;
    add_impulse(group.given, a_is_rigid ? b : a, {Partner::Kind::body, body_of(a_is_rigid ? a : b)},
                touch(c));
  };
  for (std::size_t first = 0, end = 0; first < group.contacts.size(); first = end) {
    while (end < group.contacts.size() && group.contacts[end].node == group.contacts[first].node)
      ++end;
    const double before = sum.nodes;
    if (notes_)
      exchange_node(grid, group, first, end, noted);
    else
      exchange_node(grid, group, first, end, touch);
    if (sum.nodes == before) continue;
    for (std::size_t c = first; c < end; ++c)
      for (const int f : {group.contacts[c].a, group.contacts[c].b})
        block(f).still = block(f).inert = false;
  }
  return sum;
}

}  // namespace krater
