// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/gather_patch.hpp
/// The two passes of the gather over one patch: first all velocity gradients (the means of the
/// cells need them), then what the cells give back and the constitutive stages, on runs of a few
/// lane groups, so that their records stay in the first-level cache.
#include "krater/kinematics/mpm/grid_pressure.hpp"
#include "krater/materials/batch_access.hpp"

namespace krater::inline KRATER_ISA {

inline constexpr int kStageGroups = 8;  ///< lane groups a stage works on at once

/// Ask for the whole record of a lane group: here the points come from memory, and the stages will
/// want what this pass does not. The processor itself looks ahead only within a page.
KRATER_FORCE_INLINE void fetch_record(const Patch& patch, int stride, int g) {
  if (g >= patch.points.groups()) return;
  const double* record = patch.points.data() + g * stride;
  for (int k = 0; k < stride; k += kLanes) __builtin_prefetch(record + k, 1);
}
inline constexpr int kFetchAhead = 3;  ///< lane groups

template <int Dim>
KRATER_FORCE_INLINE void note_velocity_fault(Patch& patch, const PointSums<Dim>& n, int g) {
  Pack check = n.V[0];
  for (int a = 0; a < Dim; ++a)
    for (int i = 0; i < Dim; ++i) check += n.G[a][i];
  const unsigned bad = bits(!is_finite(check) & first_lanes(patch.points.count() - kLanes * g));
  if (bad != 0 && patch.result.fault.kind == FaultKind::none)
    patch.result.fault = {FaultKind::not_finite_velocity, g, bad};
}

/// What both passes over a patch share.
struct GatherPass {
  Patch& patch;
  const BodyKernelData& body;
  const SweepSettings& s;
  const SweepScratch& w;
  GatherViews view;
  CellSums cells;
  GatherSums sums{};
  bool takes = false;  ///< heat is taken from points of some cell
};

/// New velocities of 8 points, their records in the ledger, and the work of body forces.
template <int Dim, bool Affine>
KRATER_FORCE_INLINE void book_motion(GatherPass& pass, const PointSums<Dim>& n,
                                     LaneWeights<Dim>& lw, Mask silent, int g) {
  auto& [patch, body, s, w, view, cells, sums, takes] = pass;
  Pack slots[8], loss = n.V[moved::work];
  if (s.moments) loss -= shared_motion<Dim, Affine>(view, n, w.halo, lw, g);
  update_velocity<Dim, Affine>(view, n, s, sums.base, silent, loss, g, slots);
  CellLedger<Dim>{w.cells + kCellLedger}.add(w.pressures + kLanes * g, slots);
  for (int a = 0; a < Dim; ++a)
    sums.external = fma(view.mass(g) * view.body_acceleration(g, a),
                        fnma(Pack(0.5), n.V[4 + a], n.V[a]), sums.external);
}

/// First pass: nodes -> points.
template <class Frame, class Shape, bool Affine, class Configuration, GatherPart Part>
void gather_nodes(GatherPass& pass) {
  constexpr int D = Frame::dim;
  auto& [patch, body, s, w, view, cells, sums, takes] = pass;
  const int stride = view.mass.stride;
  using T = PartTraits<Part>;
  const PatchOrigin origin = origin_of<D>(patch);
  const GridGeometry& grid = *s.geometry;
  // The first point's; none where no cell has a mean.
  double(&base)[3] = sums.base;
  for (int a = 0; a < D; ++a) base[a] = s.gamma > 0 ? get(view.velocity(0, a), 0) : 0;
  if constexpr (T::velocity) CellLedger<D>{w.cells + kCellLedger}.clear();
  const TileNodes<D, Shape> nodes{w, grid};
  LaneWeights<D> lw;
  PointSums<D> n;
  for (int g = 0; g < kFetchAhead; ++g) fetch_record(patch, stride, g);
  for (int g = 0; g < patch.points.groups(); ++g) {
    fetch_record(patch, stride, g + kFetchAhead);
    compute_weights<D, Shape, Affine && T::velocity>(grid, origin, view.grid_position,
                                                     reading(view.half_width), g, lw);
    nodes.gather(lw, n);
    double* cell = w.pressures + kLanes * g;
    store(cell, load(lw.cell));
    const Alone alone = alone_points<D>(view, n, lw, g);

    note_velocity_fault<D>(patch, n, g);
    const Pack v = 1.0 / view.density(g);
    Pack trace = 0.0, rate = 0.0;
    if constexpr (T::velocity) {
      rate = book_work<Frame, Configuration>(view, n, s, patch.beta.data(), cell, v, g);
      sums.owes = sums.owes | (view.carried(g) < Pack(0.0));
    }
    if constexpr (T::strain) {
      trace = store_gradient<Frame, Configuration, T::ended>(view, n, alone.lone, s, g);
      if (D == 3 && any(alone.thread))
        note_limit(patch.result, thread_rate<D>(view, alone.thread, grid.inv_h, g), 0, g,
                   first_lanes(patch.points.count() - kLanes * g));
      view.extra_dilatation.set(g, trace);  // tr L for now, see average_dilatation()
      if constexpr (Shape::has_width && !Configuration::fixed) carry_domain<D>(view, g);
    }
    if (s.average_cells) cells.add(cell, view.mass(g) * v, trace, rate);
    Pack old[D];
    for (int a = 0; a < D; ++a) old[a] = view.velocity(g, a);
    if constexpr (T::velocity) book_motion<D, Affine>(pass, n, lw, alone.silent, g);
    if constexpr (T::velocity || T::move || T::keep)
      move_points<Frame, Configuration, Part>(view, n, old, s, g);
    if constexpr (T::last) {
      if constexpr (!T::velocity)
        sum_kinetic<D, Affine>(view, Support::moment * grid.h * grid.h, g, sums);
      unsigned gone = 0;
      if constexpr (!Configuration::fixed)
        gone = bits(left_block<D>(s, origin, view.grid_position, g) &
                    first_lanes(patch.points.count() - kLanes * g));
      w.leavers[g] = static_cast<unsigned char>(gone);
    }
  }
}

/// What the stages of a material see of the groups [first, first + groups), but for the length.
KRATER_FORCE_INLINE BatchData batch_of(Patch& patch, const PointColumns& c, const SweepSettings& s,
                                       const SweepScratch& w, int first, int groups) {
  return {patch.points.data() + first * c.stride,
          c.stride,
          w.local + first * c.local_stride,
          c.local_stride,
          w.zeros,
          groups,
          patch.points.count() - kLanes * first,
          first,
          s.dt,
          w.zeros,
          0,
          &patch.result.ledger,
          &patch.result.fault,
          0,
          s.energy_alpha};
}

/// Debts of the points, and heat that must be taken: no more than there is. The cells' records then
/// say what share of its own each point gives, and what it carries. False: nothing is taken.
template <int Dim>
bool balance_heat(Patch& patch, const BodyKernelData& body, const SweepSettings& s,
                  const SweepScratch& w, bool owes) {
  using Cell = CellLedger<Dim>;
  const PointColumns& c = body.columns;
  double* records = w.cells + kCellLedger;
  const ReadView carried{patch.points.data() + c.carried, c.stride};
  const ReadView mass{patch.points.data() + c.mass, c.stride};
  for (int g = 0; owes && g < patch.points.groups(); ++g)
    if (any(carried(g) < Pack(0.0)))
      add_slot(records, Cell::carried, w.pressures + kLanes * g, mass(g) * carried(g));
  bool takes = patch.result.heat_taken < 0;
  for (double* r = records; owes && !takes && r < records + 8 * kBlockNodes; r += 8)
    takes = r[Cell::heat] * r[Cell::mass] + r[Cell::carried] < 0;
  patch.result.carried = patch.result.carriers = 0;
  if (!takes && !owes) return false;
  if (takes) {
    body.heat_floor->apply(batch_of(patch, c, s, w, 0, patch.points.groups()));
    const ReadView heat{w.local + c.local_heat, c.local_stride};
    for (int g = 0; g < patch.points.groups(); ++g)
      add_slot(records, Cell::taken, w.pressures + kLanes * g, mass(g) * heat(g));
  }
  for (double* r = records; r < records + 8 * kBlockNodes; r += 8) {
    if (!(r[Cell::heat] < 0 || r[Cell::carried] < 0)) {
      r[Cell::taken] = 0;
      continue;
    }
    const double due = r[Cell::heat] * r[Cell::mass] + r[Cell::carried], there = r[Cell::taken];
    r[Cell::taken] = r[Cell::carried] = 0;
    r[Cell::heat] = due / r[Cell::mass];
    if (!(due < 0)) continue;
    const bool enough = there >= -due;
    r[Cell::heat] = 0;
    r[Cell::taken] = enough ? -due / there : there > 0 ? 1 : 0;
    if (enough) continue;
    r[Cell::carried] = (due + there) / r[Cell::mass];
    patch.result.carried += due + there;
    patch.result.carriers += 1;
  }
  return takes;
}

/// The means of all cells, when all points of the patch have been seen.
template <int Dim, GatherPart Part>
void close_cells(GatherPass& pass) {
  using T = PartTraits<Part>;
  auto& [patch, body, s, w, view, cells, sums, takes] = pass;
  if constexpr (T::velocity) {
    CellLedger<Dim>{w.cells + kCellLedger}.close(s, origin_of<Dim>(patch), sums.base, patch.result);
    if (body.columns.carried >= 0)
      takes = balance_heat<Dim>(patch, body, s, w, bits(sums.owes) != 0);
    if (s.average_cells) cells.second().divide();
  }
  if (T::strain && s.average_cells) cells.divide();
}

/// What the means of the cells add to the points [first, last): velocities, heat, and what the mean
/// dilatation adds to the work of the pressure.
template <int Dim, bool Affine, GatherPart Part>
void settle(GatherPass& pass, int first, int last) {
  using Cell = CellLedger<Dim>;
  auto& [patch, body, s, w, view, cells, sums, takes] = pass;
  const PointColumns& c = body.columns;
  const Cell ledger{w.cells + kCellLedger};
  const WriteView carried{patch.points.data() + c.carried, c.stride};
  const ReadView heat{w.local + c.local_heat, c.local_stride};
  for (int g = first; g < last; ++g) {
    const double* cell = w.pressures + kLanes * g;
    Pack slots[8];
    ledger.look_up(cell, slots);
    for (int a = 0; a < Dim; ++a)
      view.velocity.set(g, a, fma(Pack(s.gamma), slots[Cell::residual + a], view.velocity(g, a)));
    Pack e = view.energy(g) + slots[Cell::heat];
    if (takes) e = fnma(slots[Cell::taken], heat(g), e);
    if (s.average_cells) {
      const Pack share = look_up(patch.beta.data(), cell) * look_up(cells.mean_rate, cell);
      e = fnma(s.dt / view.density(g), (view.pressure(g) + view.viscous(g)) * share, e);
    }
    view.energy.set(g, e);
    if (c.carried >= 0) {
      carried.set(g, slots[Cell::carried]);
      e += slots[Cell::carried];
    }
    sums.internal = fma(view.mass(g), e, sums.internal);
    if constexpr (PartTraits<Part>::last)
      sum_kinetic<Dim, Affine>(view, Support::moment * s.geometry->h * s.geometry->h, g, sums);
  }
}

/// ExtraDilatation of the groups [first, last): tr L -> dt beta (tr_c - tr L).
inline void average_dilatation(const GatherPass& pass, int first, int last) {
  const auto& [patch, body, s, w, view, cells, sums, takes] = pass;
  for (int g = first; g < last; ++g) {
    if (!s.average_cells) {
      view.extra_dilatation.set(g, Pack(0.0));
      continue;
    }
    const double* cell = w.pressures + kLanes * g;
    const Pack beta = look_up(patch.beta.data(), cell), mean = look_up(cells.value, cell);
    view.extra_dilatation.set(g, s.dt * (beta * (mean - view.extra_dilatation(g))));
  }
}

/// The volume of a fluid changes by what flows, det f + dt (tr_p - tr L): the extra dilatation a of
/// det f (1 + a/2)/(1 - a/2).
inline void add_correction(const GatherPass& pass, int first, int last) {
  const auto& [patch, body, s, w, view, cells, sums, takes] = pass;
  const ReadView correction{w.local + body.columns.local_correction, body.columns.local_stride};
  for (int g = first; g < last; ++g) {
    const Pack change = fma(Pack(s.dt), correction(g), view.extra_dilatation(g));
    const Pack j = det_minus_one(load_mat3(reading(view.step_gradient), g)) + 1.0;
    view.extra_dilatation.set(g, change / fma(Pack(0.5), change, j));
  }
}

/// Constitutive update of the groups [first, last).
template <int Dim, class Configuration>
void run_stages(GatherPass& pass, int first, int last) {
  auto& [patch, body, s, w, view, cells, sums, takes] = pass;
  const PointColumns& c = body.columns;
  alignas(64) double length[kLanes];
  store(length, Pack(s.geometry->h));
  BatchData batch = batch_of(patch, c, s, w, first, last - first);
  batch.length = length;
  for (int k = 0; k < body.stage_count; ++k) body.stages[k]->apply(batch);
  after_stages<Dim, Configuration>(patch, view, s, first, last,
                                   ReadView{w.local + c.local_rate, c.local_stride},
                                   c.indicator >= 0);
}

/// Second pass: what cells add, then the material, run by run of a few lane groups.
template <int Dim, bool Affine, class Configuration, GatherPart Part>
void finish_points(GatherPass& pass) {
  using T = PartTraits<Part>;
  const Patch& patch = pass.patch;
  const bool strains = T::strain && patch.result.fault.kind == FaultKind::none;
  close_cells<Dim, Part>(pass);
  for (int first = 0; first < patch.points.groups(); first += kStageGroups) {
    const int left = patch.points.groups() - first,
              last = first + (left < kStageGroups ? left : kStageGroups);
    if constexpr (T::velocity) settle<Dim, Affine, Part>(pass, first, last);
    if (!strains) continue;
    average_dilatation(pass, first, last);
    if (pass.body.columns.local_correction >= 0) add_correction(pass, first, last);
    run_stages<Dim, Configuration>(pass, first, last);
  }
}

template <class Frame, class Shape, bool Affine, class Configuration, GatherPart Part>
void gather_patch(Patch& patch, const BlockGrid& grid, const BodyKernelData& body,
                  const SweepSettings& s, const SweepScratch& w) {
  constexpr int D = Frame::dim;
  using T = PartTraits<Part>;
  load_nodes<D>(grid, patch, w.halo);
  GatherPass pass{patch,
                  body,
                  s,
                  w,
                  make_views(patch, body.columns, w),
                  {w.cells, w.cells + kBlockNodes, w.cells + 2 * kBlockNodes}};
  if (s.average_cells) {
    pass.cells.clear();
    clear_cells(pass.cells.mean_rate);
  }
  if (body.columns.local_correction >= 0 && (T::strain || T::velocity)) {
    // with the weights of the force: before points move
    load_halo<D>(s.pressure_nodes, patch, w.pressure_halo);
    correct_dilatation<T::velocity>(PressureSweep<Frame, Shape>{patch, body.columns, s, w});
  }
  gather_nodes<Frame, Shape, Affine, Configuration, Part>(pass);
  if constexpr (T::velocity || T::strain) finish_points<D, Affine, Configuration, Part>(pass);
  if (T::last) patch.result.kinetic = sum(pass.sums.kinetic);
  if (T::velocity) {
    patch.result.internal = sum(pass.sums.internal);
    patch.result.external_work = s.dt * sum(pass.sums.external);
  }
}

}  // namespace krater::inline KRATER_ISA
