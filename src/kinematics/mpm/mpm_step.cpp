// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/mpm/mpm_step.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "krater/core/parallel.hpp"

namespace krater {

namespace {

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
  if (loads_.any())
    loads_.collect(
        plain_, all_settings(dt), [this] { return scratch(); }, ranks_);
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
  return {m.halo.data(),  m.quadratics.data(), m.pressure_halo.data(), m.local.data(),
          m.cells.data(), m.pressures.data(),  m.leavers.data(),       zeros_.data()};
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
    m.quadratics.reserve(static_cast<std::size_t>(quadratic_doubles(grid_.geometry().dimension)));
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
  const auto scatter = [&](std::size_t first, std::size_t end) {
    for_each(end - first, [&](std::size_t i) {
      Patch& patch = grid_.patches()[stale_[first + i]];
      kernels.scatter(patch, bodies[static_cast<unsigned>(patch.body)], s[level_of(patch)],
                      scratch());
    });
  };
  if (ranks_ == nullptr) {
    scatter(0, stale_.size());
    throw_faults();
  } else {  // what others wait for first; of faults all hear in momentum()
    const auto inner = std::stable_partition(stale_.begin(), stale_.end(),
                                             [this](std::size_t p) { return ranks_->goes_out(p); });
    const auto outer = static_cast<std::size_t>(inner - stale_.begin());
    scatter(0, outer);
    ranks_->send_tiles(grid_);
    scatter(outer, stale_.size());
  }
  lap(Phase::scatter);
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
    const auto sweep = [&] {
      const bool rigid = rigid_.any() && rigid_.find(patch.body);
      if (!rigid)
        gather_and_collect(p, part, all[level_of(patch)], {moves, ahead});
      else if (moves)
        move_rigid(p, scratch());
    };
    if (ranks_ != nullptr)
      note_cost(patch, sweep);
    else
      sweep();
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
