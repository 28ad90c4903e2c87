// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/mpm/mpm_step.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "krater/core/parallel.hpp"
#include "krater/core/ranks.hpp"
#include "krater/core/reproducible_sum.hpp"

namespace krater {

namespace {

// A step is halved when the change of velocity alone would move material by more than this share of
// a cell.
constexpr double kMaxShare = 0.3;
constexpr double kNewest = 0.1;  // share of the last step in what a patch is taken to cost

/// Does its work, and smooths what that takes over steps.
template <class Work>
void note_cost(Patch& patch, const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  patch.cost += (patch.cost > 0 ? kNewest : 1) * (seconds.count() - patch.cost);
}

double alpha_of(const MethodOptions& m, double tflip) {
  switch (m.transfer) {
    case Transfer::tflip:
      return tflip;
    case Transfer::flip:
      return 1;
    case Transfer::apic:
    case Transfer::xpic:
      break;
  }
  return 0;
}

/// Share of the mean residual of a cell that its points keep.
double cell_alpha_of(const MethodOptions& m) {
  return m.transfer == Transfer::tflip || m.transfer == Transfer::flip ? 1 : 0;
}

}  // namespace

MpmStep::MpmStep(const MethodOptions& method, const Parts& parts)
    : method_{method},
      grid_{parts.grid},
      boundary_{parts.boundary},
      contact_{parts.contact},
      rigid_{parts.rigid},
      ranks_{parts.ranks},
      ties_{parts.grid, parts.boundary,
            parts.contact.active()
                ? WholeVolume{[&contact = parts.contact](const GridGeometry& g,
                                                         const std::array<int, 3>& index) {
                    return contact.whole_volume(g, index);
                  }}
                : WholeVolume{}},
      kernels_{parts.kernels},
      plain_{parts.plain},
      bodies_{parts.bodies},
      columns_{columns_of(parts.bodies)},
      velocity_from_kept_{parts.bodies},
      position_as_velocity_{parts.bodies},
      audit_{parts.audit},
      loads_{parts.loads},
      impulses_{parts.impulses},
      energy_watch_{parts.boundary},
      loaded_{parts.loads.any() ||
              std::any_of(parts.bodies.begin(), parts.bodies.end(), [](const BodyKernelData& b) {
                return b.columns.body_acceleration >= 0;
              })} {
  if (parts.carriers != nullptr)
    reference_contact_ = std::make_unique<ReferenceContact>(
        ReferenceContact::Parts{grid_, boundary_, contact_, *parts.carriers, bodies_, parts.shape});
  for (BodyKernelData& body : velocity_from_kept_)
    body.columns.velocity = body.columns.grid_velocity;
  for (BodyKernelData& body : position_as_velocity_) {
    body.columns.velocity = body.columns.position;
    body.columns.affine = body.columns.map;
  }
  zeros_.reserve(9 * kLanes);
}

PointStore& MpmStep::change(int s) {
  Patch& patch = grid_.patches()[static_cast<std::size_t>(s)];
  patch.touch();
  return patch.points;
}

double MpmStep::force(double dt) {
  watch_.start();
  audit_.step_external = 0;  // of the question before, if there was one
  external_impulse_ = {};
  if (method_.update == Update::usf && last_step_ > 0) strain_last_motion();
  if (method_.reference != Reference::current) measure_gaps();
  if (loads_.any()) loads_.collect(plain_, all_settings(dt), [this] { return scratch(); });
  particles_to_grid(kernels_, bodies_, dt);  // m_i, p_i, f_i, V_i
  grid_kinetic_ = momentum(dt, 1);           // v- = p/m, v+ = v- + dt f/m
  begin_rigid(dt, grid_kinetic_);
  return dt;
}

void MpmStep::meet(double dt) {
  if (method_.transfer == Transfer::xpic) note_forces();
  if (loads_.any()) loads_.drive(dt);
  constraints_ = constrain();
  if (impulses_.any()) note_impulses();
  if (loads_.any()) book_loads(dt);
  account_folds(dt);
  if (method_.transfer == Transfer::xpic) {
    filter_velocity(constraints_.walls.impulse);
  } else {
    write_node_work();
  }
  watch_energy();
}

Standing MpmStep::move(double dt, const Standing& others) {
  others_ = others;
  switch (method_.update) {
    case Update::usl:
      grid_to_particles(
          method_.transfer == Transfer::xpic ? GatherPart::filter_move : GatherPart::all, dt);
      break;
    case Update::musl:
      grid_to_particles(GatherPart::velocity_only, dt);
      project_again(dt);
      grid_to_particles(GatherPart::strain_move, dt);
      break;
    case Update::usf:
      grid_to_particles(GatherPart::velocity_move, dt);
      break;
  }
  last_step_ = dt;
  book();
  migrate();
  return {audit_.kinetic, audit_.internal, audit_.unfelt, audit_.law_lead, audit_.contact_pairs};
}

MpmStep::Constraints MpmStep::constrain(bool projection) {
  Constraints out;
  if (contact_.active()) out.contact = meet_bodies(projection);
  lap(Phase::contact);
  out.walls = boundary_.constrain();
  for (int level = 0; level < grid_.levels().count(); ++level) {
    if (level > 0) ties_.prolong(level);
    boundary_.mirror(level);
  }
  lap(Phase::boundary);
  return out;
}

ContactWork MpmStep::meet_bodies(bool projection) {
  if (reference_contact_) return reference_contact_->apply();
  ties_.complete_volumes();
  return contact_.apply(grid_, columns_, rigid_, projection);
}

void MpmStep::account_folds(double dt) {
  const BoundaryWork folds = boundary_.folded(dt, cell_alpha_of(method_));
  for (std::size_t a = 0; a < 3; ++a) constraints_.walls.impulse[a] += folds.impulse[a];
}

CutCells MpmStep::cut_cells(int axis, int side, const GridGeometry& geometry) const {
  if (geometry.planes_on_knots()) return {};  // between two cells
  const auto a = static_cast<unsigned>(axis);
  const Boundary& plane = boundary_.conditions()[a][static_cast<unsigned>(side)];
  if (!plane.folds()) return {};
  return {side == 0 ? 0 : geometry.cells[a], plane.kind == BoundaryKind::sticky ? 7U : 1U << axis};
}

std::vector<SweepSettings> MpmStep::all_settings(double dt) const {
  std::vector<SweepSettings> out;
  for (int level = 0; level < grid_.levels().count(); ++level) out.push_back(settings(dt, level));
  return out;
}

SweepSettings MpmStep::settings(double dt, int level) const {
  SweepSettings s;
  s.geometry = &grid_.geometry(level);
  s.dt = dt;
  s.alpha = alpha_of(method_, method_.flip_fraction);
  s.gamma = cell_alpha_of(method_) - std::min(cell_alpha_of(method_), s.alpha);
  s.moments = cell_alpha_of(method_) < 1;
  s.average_cells = method_.cell_averaging;
  s.energy_alpha = method_.energy_alpha;
  s.pressure_nodes = pressure_nodes_.data();
  for (int a = 0; a < grid_.geometry().dimension; ++a) {
    s.first[static_cast<unsigned>(a)] = boundary_.last_knots(a, 0, level);
    s.last[static_cast<unsigned>(a)] = boundary_.last_knots(a, 1, level);
    for (const int side : {0, 1})
      s.cut[static_cast<unsigned>(a)][static_cast<unsigned>(side)] =
          cut_cells(a, side, *s.geometry);
  }
  return s;
}

SweepScratch MpmStep::scratch() {
  ThreadMemory& m = memory_[static_cast<unsigned>(thread_index())];
  return {m.halo.data(),      m.pressure_halo.data(), m.local.data(), m.cells.data(),
          m.pressures.data(), m.leavers.data(),       zeros_.data()};
}

void MpmStep::relink() {
  boundary_.relink(grid_);
  if (!reference_contact_) contact_.relink(grid_);
  ties_.relink();
  waiting_blocks_.clear();
  for (std::size_t n = 0; n < grid_.node_blocks().size(); ++n)
    if (waits(grid_.node_blocks()[n])) waiting_blocks_.push_back(n);
  relink_fluids();
  if (ranks_ != nullptr) ranks_->relink(grid_);
  provide_memory();
}

void MpmStep::provide_memory() {
  int groups = 1, local = 1;
  for (const Patch& p : grid_.patches()) groups = std::max(groups, p.points.groups());
  for (const BodyKernelData& b : bodies_) local = std::max(local, b.columns.local_stride);
  const auto count = static_cast<std::size_t>(groups + groups / 4 + 1);
  memory_.resize(static_cast<std::size_t>(std::max(threads(), 1)));
  for (ThreadMemory& m : memory_) {
    m.halo.reserve(static_cast<std::size_t>(tile_nodes(grid_.geometry().dimension)) * kNodeDoubles);
    if (!fluid_patches_.empty())
      m.pressure_halo.reserve(static_cast<std::size_t>(tile_nodes(grid_.geometry().dimension)) *
                              kNodeDoubles);
    m.cells.reserve(kCellDoubles);
    m.local.reserve(static_cast<std::size_t>(groups) * static_cast<std::size_t>(local));
    m.pressures.reserve(static_cast<std::size_t>(groups) * kLanes);
    if (m.leavers.size() < static_cast<std::size_t>(groups)) m.leavers.resize(count);
  }
  removed_.resize(grid_.patches().size());
}

void MpmStep::particles_to_grid(const Kernels& kernels, const std::vector<BodyKernelData>& bodies,
                                double dt) {
  const std::vector<SweepSettings> s = all_settings(dt);
  stale_.clear();
  for (std::size_t p = 0; p < grid_.patches().size(); ++p) {
    Patch& patch = grid_.patches()[p];
    patch.result.fault = {};
    if (patch.here && patch.tile.state == Tile::State::stale) stale_.push_back(p);
  }
  for_each(stale_.size(), [&](std::size_t i) {
    Patch& patch = grid_.patches()[stale_[i]];
    kernels.scatter(patch, bodies[static_cast<unsigned>(patch.body)], s[level_of(patch)],
                    scratch());
  });
  if (ranks_ != nullptr) share_faults();
  throw_faults();
  if (ranks_ != nullptr) ranks_->exchange_tiles(grid_);
  lap(Phase::scatter);
}

std::vector<MomentumSettings> MpmStep::momentum_settings(double dt_force) const {
  std::vector<MomentumSettings> out;
  for (int level = 0; level < grid_.levels().count(); ++level) {
    MomentumSettings s = node_settings_;
    s.dt_force = dt_force;
    s.cell_volume = std::pow(grid_.geometry(level).h, grid_.geometry().dimension);
    out.push_back(s);
  }
  return out;
}

double MpmStep::momentum(double& dt, double force_share) {
  const std::vector<MomentumSettings> s = momentum_settings(force_share * dt);
  const bool fluids = !fluid_patches_.empty(), loads = loads_.any() && force_share > 0;
  const auto update = [&](std::size_t n) {
    NodeBlock& block = grid_.node_blocks()[n];
    kernels_.momentum(block, s[static_cast<std::size_t>(block.key.level)]);
  };
  for_each(
      grid_.node_blocks().size(),
      [&](std::size_t n) {
        NodeBlock& block = grid_.node_blocks()[n];
        if (asleep(block)) return;
        kernels_.sum_tiles(grid_, block);
        if (!waits(block) && !fluids && !loads) update(n);
      },
      few_blocks());
  if (fluids) {
    if (force_share > 0 || method_.update == Update::usf) collect_pressure(settings(dt));
    if (force_share > 0) add_pressure_force(settings(dt));
  }
  if (loads) loads_.add_forces(dt, node_settings_.smallest_mass);
  if (fluids || loads)
    for_each(
        grid_.node_blocks().size(),
        [&](std::size_t n) {
          if (!waits(grid_.node_blocks()[n])) update(n);
        },
        few_blocks());
  lap(Phase::nodes);
  for (int level = grid_.levels().count() - 1; level >= 0; --level) {
    boundary_.fold(level);
    if (level > 0) ties_.restrict(level);
  }
  for_each(
      waiting_blocks_.size(), [&](std::size_t i) { update(waiting_blocks_[i]); }, few_blocks());
  ties_.sharpen(s);
  const double share = safe_share(force_share * dt);
  if (share < 1) shorten(dt, share);
  lap(Phase::boundary);
  ReproducibleSum kinetic;
  for (const NodeBlock& block : grid_.node_blocks()) {
    if (!block.counted || (rigid_.any() && rigid_.find(body_of(block.field)))) continue;
    kinetic += block.sums.kinetic;
  }
  ranks::sum({&kinetic, 1});
  return rigid_.kinetic() + kinetic.value();
}

/// Share of a step that the change of velocity alone may move material through its cells; halved
/// until it does.
double MpmStep::safe_share(double dt_force) const {
  double most = 0;  // in cells of the coarsest level
  for (const NodeBlock& block : grid_.node_blocks())
    if (block.counted) most = std::max(most, std::ldexp(block.sums.max_change, block.key.level));
  most = ranks::max(most);
  double share = 1;
  while (share * most * share * dt_force > kMaxShare * grid_.geometry().h) share *= 0.5;
  return share;
}

void MpmStep::shorten(double& dt, double share) {
  ties_.shorten(share);
  dt *= share;
  audit_.retries += 1;
  for (NodeBlock& block : grid_.node_blocks()) {
    block.sums.kinetic = 0;
    for (double* node = block.nodes; node < block.nodes + kBlockNodes * kNodeDoubles;
         node += kNodeDoubles) {
      double speed2 = 0;
      for (int a = 0; a < 3; ++a) {
        node[a] -= (1 - share) * node[4 + a];
        node[4 + a] *= share;
        speed2 += node[a] * node[a];
      }
      block.sums.kinetic += 0.5 * node[3] * speed2;
    }
  }
}

void MpmStep::grid_to_particles(GatherPart part, double dt) {
  boundary_.set_step(dt);
  std::vector<SweepSettings> all = all_settings(dt);
  for (SweepSettings& s : all) s.may_sleep = may_sleep(part);
  const bool ahead = may_scatter_ahead(part);
  const bool moves = part != GatherPart::keep_only && part != GatherPart::velocity_only &&
                     part != GatherPart::strain_only;
  if (moves && rigid_.any()) finish_rigid(dt);
  if (!fluid_patches_.empty() && part != GatherPart::keep_only) correct_dilatation(all.front());
  for_each(grid_.patches().size(), [&](std::size_t p) {
    Patch& patch = grid_.patches()[p];
    if (!patch.here) return;
    if (patch.tile.state == Tile::State::ahead) patch.tile.state = Tile::State::stale;
    if (rigid_.any() && rigid_.find(patch.body)) {
      if (moves) note_cost(patch, [&] { move_rigid(p, scratch()); });
      return;
    }
    const AfterGather then{moves, ahead};
    if (ranks_ != nullptr)
      note_cost(patch, [&] { gather_and_collect(p, part, all[level_of(patch)], then); });
    else
      gather_and_collect(p, part, all[level_of(patch)], then);
  });
  if (ranks_ != nullptr) ranks_->share_results(grid_, removed_);
  lap(Phase::gather);
  double scattering = 0;
  for (ThreadMemory& m : memory_) {
    scattering += m.scatter_seconds;
    m.scatter_seconds = 0;
  }
  watch_.move(static_cast<std::size_t>(Phase::gather), static_cast<std::size_t>(Phase::scatter),
              scattering / static_cast<double>(memory_.size()));
  throw_faults();
  if (moves && rigid_.any()) rigid_.throw_collisions(grid_);
  if (part != GatherPart::keep_only) combine_patches(part);
}

void MpmStep::throw_faults() const {
  for (std::size_t p = 0; p < grid_.patches().size(); ++p)
    if (grid_.patches()[p].result.fault.kind != FaultKind::none)
      throw StepFault{static_cast<int>(p), grid_.patches()[p].result.fault};
}

}  // namespace krater
