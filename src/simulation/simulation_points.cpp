// SPDX-License-Identifier: GPL-3.0-or-later
// The material points of the start: each body's lattice is that of the coarsest cells in which some
// of it lies; what lies in finer ones is split as it would be if it came there
// (kinematics/mpm/split.hpp).
#include <algorithm>
#include <cmath>
#include <map>

#include "krater/core/errors.hpp"
#include "krater/kinematics/mpm/stretch.hpp"
#include "krater/simulation/point_maker.hpp"
#include "krater/simulation/refinement.hpp"
#include "krater/simulation/simulation.hpp"
#include "krater/simulation/torn_points.hpp"

namespace krater {

void Simulation::find_levels() {
  if (scene_.grid.refine.empty()) return;
  for (const auto& body : bodies_)
    if (body->pressure_on_grid(scene_))
      throw InputError(scene_.grid.refine.front().where + ": finer cells do not go with body '" +
                       body->name() +
                       "', whose pressure is integrated on the grid as a fluid's; use "
                       "method.grid_pressure: none, or no grid.refine");
  refinement_ = std::make_unique<Refinement>(scene_, geometry_, bodies_);
  std::vector<BlockSet> blocks(bodies_.size());
  for (const RefineOptions& rule : scene_.grid.refine) {
    if (rule.follow < 0) continue;
    const auto b = static_cast<std::size_t>(rule.follow);
    for (const SeedPoint& seed : bodies_[b]->lattice(scene_, 0))
      blocks[b].insert(block_of(geometry_, seed.x.data()));
  }
  grid_.set_levels(refinement_->at_start(blocks));
}

int Simulation::coarsest_level(int body) {
  const Levels& levels = grid_.levels();
  if (levels.single()) return 0;
  int level = levels.count() - 1;
  for (const SeedPoint& seed : bodies_[static_cast<std::size_t>(body)]->lattice(scene_, 0))
    level = std::min(level, levels.block_at(seed.x.data()).level);
  return level;
}

namespace {

/// The body is all around a seed, three of its own widths in all, as kinematics/mpm/interior.hpp
/// means it.
bool inside(const Scene& scene, const BodyOptions& body, const SeedPoint& seed) {
  constexpr double kWidths = 7 * (1 - 1e-9);  // of half of it, to either side
  const int dim = dimension(scene.frame);
  Box around{seed.x, seed.x};
  for (int a = 0; a < dim; ++a) {
    const auto k = static_cast<std::size_t>(a);
    around.min[k] -= kWidths * seed.half_width[k];
    around.max[k] += kWidths * seed.half_width[k];
    const auto& sides = scene.grid.boundary[k];
    const bool low = around.min[k]<scene.grid.min[k], high = around.max[k]> scene.grid.max[k];
    if ((low || high) && a == dim - 1) return false;
    if ((low && !sides[0].folds()) || (high && !sides[1].folds())) return false;
  }
  return body.solid->classify(scene.frame, intersection(around, domain_box(scene), dim)) ==
         Place::inside;
}

}  // namespace

/// Who has the blocks that the bodies lie in, by the points of their lattices.
void Simulation::deal_lattices() {
  std::map<BlockKey, double> points;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (!bodies_[b]->options().material_points()) continue;
    const int from = coarsest_level(static_cast<int>(b));
    for (const SeedPoint& seed : bodies_[b]->lattice(scene_, from))
      points[grid_.levels().block_at(seed.x.data())] += 1;
  }
  ranks_->deal(grid_, points);
}

double Simulation::place_body(int b) {
  Body& body = *bodies_[static_cast<std::size_t>(b)];
  const PointColumns& columns = kernel_data_[static_cast<std::size_t>(b)].columns;
  PointSize& size = step_->sizes()[static_cast<std::size_t>(b)];
  const int from = coarsest_level(b), finest = grid_.levels().count() - 1;
  const std::vector<SeedPoint> seeds = body.seeds(scene_, from);
  size.next_id = static_cast<double>(seeds.size());
  PointMaker maker{scene_, b, body};
  std::map<BlockKey, std::size_t> where;
  std::vector<Arrival> parts;
  double smallest = 0;
  const auto mass_at = static_cast<std::size_t>(columns.mass / kLanes);
  const auto patch_at = [&](const BlockKey& key) -> Patch& {
    const auto [at, is_new] = where.try_emplace(key, grid_.patches().size());
    return is_new ? grid_.add_patch(key, b, columns.stride) : grid_.patches()[at->second];
  };
  for (std::size_t id = 0; id < seeds.size(); ++id) {
    const double m = body.material().density * seeds[id].measure;
    smallest = smallest > 0 ? std::min(smallest, m) : m;
    const double lit = detonation_.burns(b) ? detonation_.since_lighting(b, seeds[id].x) : 0;
    const BlockKey owner = grid_.levels().block_at(seeds[id].x.data());
    if (owner.level <= from && !patch_at(owner).here) {  // another rank makes it
      ++patch_at(owner).held;
      continue;
    }
    std::vector<double>& record = maker.make(seeds[id], id);
    if (detonation_.burns(b))
      record[static_cast<std::size_t>(body.slot(field::SinceLighting::info))] = lit;
    parts.clear();
    if (owner.level <= from)
      parts.push_back({owner, b, record});
    else
      arrive(grid_.levels(), columns, size, from,
             {owner, b, record, size.stagger && inside(scene_, body.options(), seeds[id])}, parts,
             &seeds[id].half_width);
    for (Arrival& part : parts) {
      if (parts.size() > 1) {
        const double halvings =
            std::round(std::log2(part.record[mass_at] / record[mass_at]) / geometry_.dimension);
        maker.set_motion(part.record, seeds[id], std::exp2(halvings));
      }
      Patch& patch = patch_at(part.key);
      if (patch.here)
        patch.append(part.record.data());
      else
        ++patch.held;
    }
  }
  // what splitting may still make of them
  return smallest * std::pow(corner_count(geometry_.dimension), from - finest) *
         (size.halves ? kLightest : 1);
}

/// Its points are cut where they are long (kinematics/mpm/stretch.hpp).
bool Simulation::may_split(const Body& body) const {
  if (scene_.method.numerical_fracture != NumericalFracture::split || !may_tear(body)) return false;
  for (int a = 0; a < geometry_.dimension; ++a)
    if (body.options().points.per_direction[static_cast<std::size_t>(a)] < 2)
      throw InputError(body.options().where +
                       ": method.numerical_fracture: split needs two points per direction and "
                       "cell or more, for points longer than 3/4 of a cell are split");
  return true;
}

void Simulation::place_points() {
  std::vector<PointSize> sizes;
  for (const auto& body : bodies_)
    sizes.push_back({body->material().density, body->options().points.per_direction,
                     scene_.frame == Frame::axisymmetric, scene_.method.stagger, 0,
                     may_split(*body)});
  step_->set_sizes(std::move(sizes));
  std::vector<MergePlan> plans;
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    plans.push_back(plan_merging(bodies_[b]->layout(), kernel_data_[b].columns));
  step_->set_merge_plans(std::move(plans));
  if (ranks_) deal_lattices();
  double smallest = 0;
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    if (bodies_[b]->options().material_points()) {
      const double m = place_body(static_cast<int>(b));
      smallest = smallest > 0 ? std::min(smallest, m) : m;
    }
  detonation_.require_all_lit();
  for (Patch& p : grid_.patches())
    if (!p.points.empty())
      p.points.pad(kernel_data_[static_cast<std::size_t>(p.body)].columns.mass);
  grid_.rebuild(true);
  step_->set_smallest_mass(smallest);
  step_->relink();
}

void Simulation::choose_first_step() {
  struct Fastest {
    double speed = 0, id = 0;
  };
  std::vector<Fastest> by_patch(grid_.patches().size());
  for (std::size_t n = 0; n < by_patch.size(); ++n) {
    const Patch& p = grid_.patches()[n];
    const PointColumns& c = kernel_data_[static_cast<std::size_t>(p.body)].columns;
    for (int i = 0; i < p.points.count(); ++i)
      for (int a = 0; a < geometry_.dimension; ++a)
        if (const double speed = std::abs(p.points.at(c.velocity + kLanes * a, i));
            speed > by_patch[n].speed)
          by_patch[n] = {speed, p.points.at(0, i)};
  }
  if (ranks_) ranks_->share(grid_, by_patch);
  double fastest = 0, signal = 0, inv_h = 0;
  for (std::size_t n = 0; n < by_patch.size(); ++n) {
    const Patch& p = grid_.patches()[n];
    inv_h = std::max(inv_h, grid_.geometry(p.key.level).inv_h);
    const Body& body = *bodies_[static_cast<std::size_t>(p.body)];
    signal = std::max(signal, body.signal_speed());
    if (by_patch[n].speed <= fastest) continue;
    fastest = by_patch[n].speed;
    limit_.body = p.body;
    limit_.id = by_patch[n].id;
  }
  step_->set_reference_speed(fastest);
  // The closing speed of two bodies is at most twice the greatest speed.
  limit_.rate = std::max((2 * fastest + signal) * inv_h, detonation_.rate(time()));
  for (const Kinematics* k : movers_)
    if (k != step_.get() && k->limit().rate > limit_.rate) limit_ = k->limit();
  require_steps(scene_.time, clock_.stable_step(limit_.rate));
  clock_.start(limit_.rate);
}

}  // namespace krater
