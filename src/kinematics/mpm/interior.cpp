// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/mpm/interior.hpp"

#include <algorithm>
#include <cmath>

namespace krater {

namespace {

constexpr double kFull = 0.7;

std::array<int, 3> cell_at(const GridGeometry& g, const double* position) {
  std::array<int, 3> cell{};
  for (int a = 0; a < g.dimension; ++a)
    cell[static_cast<std::size_t>(a)] = static_cast<int>(std::floor(g.knots(position[a], a)));
  return cell;
}

}  // namespace

/// A plane of the domain cuts the cells of level 0 in half: these are not judged.
Interior::Side Interior::side_of(const Cell& cell, const GridGeometry& g) const {
  Side out = Side::inside;
  for (int a = 0; a < g.dimension; ++a) {
    const auto k = static_cast<std::size_t>(a);
    const double middle = cell[k] + 0.5;
    const bool low = middle <= g.origin, high = middle >= g.origin + g.cells[k];
    if (!low && !high) continue;
    const Boundary& side = conditions_[k][low ? 0 : 1];
    if (!side.folds() || a == g.dimension - 1) return Side::end;
    out = Side::image;
  }
  return out;
}

bool Interior::holds(const double* position, int level, int body) {
  const GridGeometry& g = grid_.geometry(level);
  const Cell home = cell_at(g, position);
  for (int slot = 0; slot < neighbour_count(g.dimension); ++slot) {
    Cell cell = home;
    for (int a = 0; a < g.dimension; ++a)
      cell[static_cast<std::size_t>(a)] += slot_offset(slot, a, g.dimension);
    const Side side = side_of(cell, g);
    if (side == Side::end) return false;
    if (side == Side::inside && !full({cell, level, body})) return false;
  }
  return true;
}

bool Interior::full(const CellKey& key) {
  const auto [at, is_new] = full_.try_emplace(key, false);
  if (!is_new) return at->second;
  const GridGeometry& g = grid_.geometry(key.level);
  const PointSize& size = sizes_[static_cast<std::size_t>(key.body)];
  double due = size.mass(g, g.min[0] + (key.cell[0] + 0.5 - g.origin) * g.h);
  for (int a = 0; a < g.dimension; ++a) due *= size.per_direction[static_cast<std::size_t>(a)];
  return at->second = mass(key.cell, key.level, key.body) > kFull * due;
}

/// Of the cells that lie in it, or its share of the coarser one around it.
double Interior::mass(const Cell& cell, int level, int body) {
  const int dimension = grid_.geometry().dimension;
  const auto [key, local] = grid_.place_of_node(cell, level);
  Cell other{};
  if (!grid_.levels().holds(key)) {
    for (std::size_t a = 0; a < 3; ++a) other[a] = floor_div(cell[a], 2);
    return mass(other, level - 1, body) / corner_count(dimension);
  }
  if (!grid_.levels().is_refined(key)) return masses(key, body)[static_cast<std::size_t>(local)];
  double sum = 0;
  for (int corner = 0; corner < corner_count(dimension); ++corner) {
    for (int a = 0; a < dimension; ++a) {
      const auto k = static_cast<std::size_t>(a);
      other[k] = 2 * cell[k] + corner_offset(corner, a);
    }
    sum += mass(other, level + 1, body);
  }
  return sum;
}

const Interior::Masses& Interior::masses(const BlockKey& key, int body) {
  if (!counted_) add_travellers();
  const auto [at, is_new] = masses_.try_emplace({key, body});
  if (!is_new) return at->second;
  if (const auto there = masses_there_.find({key, body}); there != masses_there_.end())
    at->second = there->second;
  else if (const int p = grid_.find_patch(key, body); p >= 0)
    at->second = masses_of(grid_.patches()[static_cast<std::size_t>(p)]);
  if (const auto found = travelling_.find({key, body}); found != travelling_.end())
    for (std::size_t n = 0; n < kBlockNodes; ++n) at->second[n] += found->second[n];
  return at->second;
}

/// Of the points that stay.
Interior::Masses Interior::masses_of(const Patch& patch) const {
  Masses out{};
  const PointColumns& c = bodies_[static_cast<std::size_t>(patch.body)].columns;
  for (int i = 0; i < patch.points.count(); ++i) {
    double position[3] = {};
    for (int a = 0; a < grid_.geometry().dimension; ++a)
      position[a] = patch.points.at(c.position + kLanes * a, i);
    const int cell = cell_in_block(grid_.geometry(patch.key.level), position);
    out[static_cast<std::size_t>(cell)] += patch.points.at(c.mass, i);
  }
  return out;
}

std::vector<Interior::Traveller> Interior::travellers_of(const Patch& patch) const {
  std::vector<Traveller> out;
  const PointColumns& c = bodies_[static_cast<std::size_t>(patch.body)].columns;
  const auto width = static_cast<std::size_t>(c.stride / kLanes);
  for (const std::vector<double>* records : {&patch.outbox.records, &patch.outbox.other_level})
    for (std::size_t k = 0; k < records->size(); k += width) {
      const double *point = records->data() + k, *position = point + c.position / kLanes;
      const BlockKey key = grid_.levels().block_at(position);
      out.push_back(
          {key, cell_in_block(grid_.geometry(key.level), position), point[c.mass / kLanes]});
    }
  return out;
}

void Interior::add_travellers() {
  counted_ = true;
  for (const Patch& patch : grid_.patches()) {
    const auto there = travellers_there_.find({patch.key, patch.body});
    for (const Traveller& t :
         there != travellers_there_.end() ? there->second : travellers_of(patch))
      travelling_[{t.to, patch.body}][static_cast<std::size_t>(t.cell)] += t.mass;
  }
}

void Interior::exchange(const Distribution& ranks) {
  ranks.exchange_near(
      [this](std::size_t p, std::vector<double>& out) {
        const Patch& patch = grid_.patches()[p];
        const Masses masses = masses_of(patch);
        out.insert(out.end(), masses.begin(), masses.end());
        const std::vector<Traveller> travellers = travellers_of(patch);
        out.push_back(static_cast<double>(travellers.size()));
        for (const Traveller& t : travellers)
          out.insert(out.end(), {1.0 * t.to.i[0], 1.0 * t.to.i[1], 1.0 * t.to.i[2],
                                 1.0 * t.to.level, 1.0 * t.cell, t.mass});
      },
      [this](std::size_t p, const double*& at) {
        const Patch& patch = grid_.patches()[p];
        std::copy_n(at, kBlockNodes, masses_there_[{patch.key, patch.body}].begin());
        at += kBlockNodes;
        auto& travellers = travellers_there_[{patch.key, patch.body}];
        travellers.resize(static_cast<std::size_t>(*at++));
        for (Traveller& t : travellers) {
          for (std::int32_t& i : t.to.i) i = static_cast<std::int32_t>(*at++);
          t.to.level = static_cast<std::int32_t>(*at++);
          t.cell = static_cast<int>(*at++);
          t.mass = *at++;
        }
      });
}

int Interior::cell_in_block(const GridGeometry& g, const double* position) const {
  return grid_.place_of_node(cell_at(g, position), g.level).second;
}

}  // namespace krater
