// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/gather.hpp
/// grid_to_particles of one patch, then the constitutive stages on the points while they are in the
/// cache:
///   s+ = sum S v+,  s- = s+ - sum S dv,  x_p <- x_p + dt s+,
///   v_p <- s+ + <r> + alpha (r - <r>),  r = v_p - s-,
///   L = sum v+ (x) grad S  (axisymmetric: L_tt = s+_r/r),  tr_c averaged over the cell.
/// alpha = 1: FLIP; between 0 and 1: TFLIP, with the mean <r> of the points of the body in the cell
/// (kinematics/mpm/ledger.hpp), so that no momentum leaves it; APIC and XPIC have alpha = 0 and no
/// <r>. Points that see hardly any other: kinematics/mpm/lone.hpp.
#include "krater/core/stability.hpp"
#include "krater/kinematics/mpm/ledger.hpp"
#include "krater/kinematics/mpm/lone.hpp"

namespace krater::inline KRATER_ISA {

/// Copy the tile of nodes around a block: the block itself and its neighbours above.
/// `nodes`: records of all node blocks, one after the other.
template <int Dim>
void load_halo(const double* nodes, const Patch& patch, double* halo) {
  constexpr int E = block_edge(Dim), T = tile_edge(Dim), rows = Dim == 3 ? T : 1;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < T; ++j)
      for (int high = 0; high < 2; ++high) {
        const int corner = Dim == 3 ? (i / E) + 2 * (j / E) + 4 * high : (j / E) + 2 * high;
        const double* block = nodes + static_cast<std::size_t>(
                                          patch.links.node_blocks[static_cast<unsigned>(corner)]) *
                                          kBlockNodes * kNodeDoubles;
        const double* from = block + kNodeDoubles * (((i % E) * E + j % E) * E);
        double* to = halo + kNodeDoubles * ((i * T + j) * T + E * high);
        for (int k = 0; k < (high != 0 ? T - E : E); ++k) store(to + 8 * k, load(from + 8 * k));
      }
}

/// The nodes that the gather reads; k is zero where a block at rest has kept its volumes.
template <int Dim>
void load_nodes(const BlockGrid& grid, const Patch& patch, double* halo) {
  load_halo<Dim>(grid.nodes(), patch, halo);
  constexpr int E = block_edge(Dim), T = tile_edge(Dim);
  unsigned kept = 0;
  for (int corner = 0; corner < corner_count(Dim); ++corner)
    if (keeps_volumes(grid.node_blocks()[static_cast<unsigned>(
            patch.links.node_blocks[static_cast<unsigned>(corner)])]))
      kept |= 1U << corner;
  if (kept == 0) return;
  for (int n = 0; n < tile_nodes(Dim); ++n) {
    const int i = n / (T * T), j = n / T % T, k = n % T;
    const int corner = Dim == 3 ? i / E + 2 * (j / E) + 4 * (k / E) : j / E + 2 * (k / E);
    if ((kept >> corner & 1U) != 0) halo[kNodeDoubles * n + moved::work] = 0;
  }
}

/// Running sums of a patch, one per lane, folded once at the end.
struct GatherSums {
  Pack kinetic = 0.0, internal = 0.0, external = 0.0;
  double base[3] = {};         ///< velocity that the ledger counts from
  Mask owes = first_lanes(0);  ///< some point carries a debt
};

template <GatherPart Part>
struct PartTraits {
  static constexpr bool velocity = Part == GatherPart::all || Part == GatherPart::velocity_only ||
                                   Part == GatherPart::velocity_move ||
                                   Part == GatherPart::filter_move;
  static constexpr bool strain = Part == GatherPart::all || Part == GatherPart::strain_move ||
                                 Part == GatherPart::strain_only || Part == GatherPart::filter_move;
  static constexpr bool keep =
      Part == GatherPart::velocity_only || Part == GatherPart::keep_only;  ///< for later
  static constexpr bool move = !keep && Part != GatherPart::strain_only;
  static constexpr bool kept = Part == GatherPart::strain_move;  ///< move with the kept s+
  static constexpr bool mean =
      Part == GatherPart::filter_move;  ///< move with the mean of old and new v_p
  static constexpr bool ended = Part == GatherPart::strain_only;  ///< strain of the move before
  static constexpr bool last = move;  ///< velocities are final: sum the energies
};

/// Position of 8 points.
template <class Frame, class Configuration, GatherPart Part>
KRATER_FORCE_INLINE void move_points(const GatherViews& view, const PointSums<Frame::dim>& n,
                                     const Pack (&old)[Frame::dim], const SweepSettings& s, int g) {
  using T = PartTraits<Part>;
  for (int a = 0; a < Frame::dim; ++a) {
    Pack carried = n.V[a];  // velocity the position moves with
    if constexpr (T::mean) carried = 0.5 * (old[a] + view.velocity(g, a));
    if constexpr (T::keep || Configuration::fixed) view.kept.set(g, a, n.V[a]);
    if constexpr (T::kept) carried = view.kept(g, a);
    if constexpr (T::move) view.position.set(g, a, fma(Pack(s.dt), carried, view.position(g, a)));
  }
}

/// W of 8 points into their energy, but for what the mean over the cell adds (settle()); `v`: their
/// specific volume. Returns the trace of the mean L.
template <class Frame, class Configuration>
KRATER_FORCE_INLINE Pack book_work(const GatherViews& view, const PointSums<Frame::dim>& n,
                                   const SweepSettings& s, const double* beta, const double* cell,
                                   Pack v, int g) {
  const auto L =
      mean_gradient<Frame, Configuration>(n.V, n.G, view.position(g, 0), reading(view.map), g);
  Pack own = (view.pressure(g) + view.viscous(g)) * L.trace;
  if (s.average_cells) own = fnma(look_up(beta, cell), own, own);
  const Pack power = deviator_power<Frame>(view.stress, L, g) - own;
  view.energy.set(g, fma(s.dt * v, power, view.energy(g)));
  return L.trace;
}

/// Where no mean of the cell is kept (APIC, XPIC) the loss on the way to the grid is taken pair by
/// pair, sum S |u_ip - v-_i|^2/2 with u = v_p + L d, which no motion of the observer changes; the
/// nodes hold k + |v-|^2, and this is the rest, v_p.s- + L : sum S v- (x) d.
template <int Dim, bool Affine>
KRATER_FORCE_INLINE Pack shared_motion(const GatherViews& view, const PointSums<Dim>& n,
                                       const double* halo, LaneWeights<Dim>& lw, int g) {
  Pack sum = 0.0;
  for (int a = 0; a < Dim; ++a) sum = fma(view.velocity(g, a), n.V[a] - n.V[4 + a], sum);
  if constexpr (Affine) {
    for (int a = 0; a < Dim; ++a)
      for (int i = 0; i < Support::support; ++i) store(lw.d[a][i], load(lw.xw[a][i]));
    PointSums<Dim> moment;
    gather_group<Dim>(halo, lw, moment);
    for (int a = 0; a < Dim; ++a)
      for (int i = 0; i < Dim; ++i)
        sum = fma(view.affine(g, Dim * i + a), moment.G[a][i] - moment.G[a][4 + i], sum);
  }
  return sum;
}

/// Velocities of 8 points, without the means of their cells, and L; the loss of their motion into
/// the ledger. `base`: the velocity from which the ledger counts; `loss`: sum S k.
template <int Dim, bool Affine>
KRATER_FORCE_INLINE void update_velocity(const GatherViews& view, const PointSums<Dim>& n,
                                         const SweepSettings& s, const double* base, Mask silent,
                                         Pack loss, int g, Pack (&slots)[8]) {
  using Cell = CellLedger<Dim>;
  const Pack m = view.mass(g), filter = 1.0 - s.alpha;
  Pack squares = 0.0;
  for (Pack& slot : slots) slot = 0.0;
  slots[Cell::mass] = m;
  for (int a = 0; a < Dim; ++a) {
    const Pack plus = n.V[a], change = n.V[4 + a], old = view.velocity(g, a);
    const Pack residual = old - (plus - change), flip = (old - base[a]) + change;
    view.velocity.set(g, a, fma(Pack(s.alpha), residual, plus));
    loss = fnma(change, fma(Pack(0.5), change, old), loss);
    loss = fma(filter * residual, fnma(0.5 * filter, residual, flip), loss);
    slots[Cell::residual + a] = m * residual;
    slots[Cell::velocity + a] = m * flip;
  }
  if constexpr (Affine)
    for (int a = 0; a < Dim; ++a)
      for (int i = 0; i < Dim; ++i) {
        const Pack old = view.affine(g, Dim * i + a), now = select(silent, Pack(0.0), n.G[a][i]);
        view.affine.set(g, Dim * i + a, now);
        squares = fma(old - now, old + now, squares);
      }
  slots[Cell::heat] =
      m * fma(Pack(0.5 * Support::moment * s.geometry->h * s.geometry->h), squares, loss);
}

/// X (I - X)^-1: the map of a step less the identity, from dt L on the configuration at its end.
template <int Dim>
KRATER_FORCE_INLINE void from_the_end(Pack (&X)[Dim][Dim]) {
  Pack A[Dim][Dim], inverse[Dim][Dim], product[Dim][Dim];
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) A[i][j] = (i == j ? 1.0 : 0.0) - X[i][j];
  invert<Dim>(A, inverse);
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) {
      product[i][j] = 0.0;
      for (int k = 0; k < Dim; ++k) product[i][j] = fma(X[i][k], inverse[k][j], product[i][j]);
    }
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) X[i][j] = product[i][j];
}

/// f - I of the step over tensor axes into the local record; on a fixed reference F goes on to the
/// end of the step. `Ended`: the points have moved already (usf). Lone points: close_lone().
/// Returns tr L.
template <class Frame, class Configuration, bool Ended>
KRATER_FORCE_INLINE Pack store_gradient(const GatherViews& view, const PointSums<Frame::dim>& n,
                                        Mask lone, const SweepSettings& s, int g) {
  const double dt = s.dt;
  constexpr int D = Frame::dim;
  Pack L[D][D];
  for (int i = 0; i < D; ++i)
    for (int a = 0; a < D; ++a) L[i][a] = n.G[a][i];
  if constexpr (Configuration::fixed) {
    const InverseMap<D> inverse = inverse_map<D>(reading(view.map), g);
    for (int i = 0; i < D; ++i)
      for (int j = 0; j < D; ++j) {
        L[i][j] = 0.0;
        for (int a = 0; a < D; ++a) L[i][j] = fma(n.G[a][i], inverse.m[a][j], L[i][j]);
      }
    for (int i = 0; i < D; ++i)
      for (int a = 0; a < D; ++a)
        view.map.set(g, D * i + a, fma(Pack(dt), n.G[a][i], view.map(g, D * i + a)));
  }
  Pack trace = 0.0, hoop = 0.0;
  if constexpr (Frame::hoop) hoop = n.V[0] / view.position(g, 0);
  if constexpr (D == 2)
    for (int k = 0; k < 9; ++k) view.step_gradient.set(g, k, Pack(0.0));
  if (any(lone)) close_lone<Frame>(view, lone, hoop, s, g, L);
  Pack step[D][D];
  for (int i = 0; i < D; ++i)
    for (int a = 0; a < D; ++a) step[i][a] = dt * L[i][a];
  if constexpr (Ended) from_the_end<D>(step);
  for (int i = 0; i < D; ++i) {
    for (int a = 0; a < D; ++a)
      view.step_gradient.set(g, 3 * tensor_axis<D>(i) + tensor_axis<D>(a), step[i][a]);
    trace += Ended ? step[i][i] * (1 / dt) : L[i][i];
  }
  if constexpr (Frame::hoop) {
    const Pack change = Ended ? dt * hoop / (1.0 - dt * hoop) : dt * hoop;
    view.step_gradient.set(g, 4, change);
    trace += Ended ? change * (1 / dt) : hoop;
  }
  return trace;
}

/// Tensor of the squared half-widths, M <- f M f^T, and the half-widths sqrt(M_aa): a domain that
/// turns with its material keeps its size, one that was stretched turns its length along.
template <int Dim>
KRATER_FORCE_INLINE void carry_domain(const GatherViews& view, int g) {
  const auto slot = [](int a, int b) { return voigt(tensor_axis<Dim>(a), tensor_axis<Dim>(b)); };
  Pack f[Dim][Dim], half[Dim][Dim], M[Dim][Dim];
  for (int i = 0; i < Dim; ++i)
    for (int a = 0; a < Dim; ++a) {
      f[i][a] = view.step_gradient(g, 3 * tensor_axis<Dim>(i) + tensor_axis<Dim>(a));
      if (i == a) f[i][a] += 1.0;
      M[i][a] = view.domain(g, slot(i, a));
    }
  for (int i = 0; i < Dim; ++i)
    for (int b = 0; b < Dim; ++b) {
      half[i][b] = 0.0;
      for (int a = 0; a < Dim; ++a) half[i][b] = fma(f[i][a], M[a][b], half[i][b]);
    }
  for (int i = 0; i < Dim; ++i)
    for (int j = i; j < Dim; ++j) {
      Pack sum = 0.0;
      for (int b = 0; b < Dim; ++b) sum = fma(half[i][b], f[j][b], sum);
      view.domain.set(g, slot(i, j), sum);
      if (i == j) view.half_width.set(g, i, sqrt(sum));
    }
}

/// Kinetic energy, affine part 1/2 m h^2/4 L:L included.
template <int Dim, bool Affine>
KRATER_FORCE_INLINE void sum_kinetic(const GatherViews& view, double moment, int g,
                                     GatherSums& sums) {
  Pack twice = 0.0;
  for (int a = 0; a < Dim; ++a) twice = fma(view.velocity(g, a), view.velocity(g, a), twice);
  if constexpr (Affine)
    for (int a = 0; a < Dim; ++a) {
      Pack squared = 0.0;
      for (int i = 0; i < Dim; ++i) {
        const Pack L = view.affine(g, Dim * i + a);
        squared = fma(L, L, squared);
      }
      twice = fma(Pack(moment), squared, twice);
    }
  sums.kinetic = fma(0.5 * view.mass(g), twice, sums.kinetic);
}

/// Lanes whose point is no longer in this block or not inside the domain.
template <int Dim>
KRATER_FORCE_INLINE Mask left_block(const SweepSettings& settings, const PatchOrigin& origin,
                                    ReadView x, int g) {
  const GridGeometry& grid = *settings.geometry;
  Mask out = Pack(0.0) > Pack(0.0);
  for (int a = 0; a < Dim; ++a) {
    const Pack t = knots(grid, x(g, a), a);
    const Pack cell = Support::base(t) - origin.first[a];
    out = out | (cell < Pack(0.0)) | (cell >= Pack(static_cast<double>(block_edge(Dim)))) |
          (t < Pack(settings.first[static_cast<unsigned>(a)])) |
          (t > Pack(settings.last[static_cast<unsigned>(a)]));
  }
  return out;
}

KRATER_FORCE_INLINE void note_limit(PatchResult& r, Pack rate, int kind, int g, Mask valid) {
  const Pack candidate = select(valid, rate, Pack(0.0));
  if (!any(candidate > Pack(r.max_rate))) return;
  for (int l = 0; l < kLanes; ++l)
    if (get(candidate, l) > r.max_rate) {
      r.max_rate = get(candidate, l);
      r.limiter = kind;
      r.limiting_point = kLanes * g + l;
    }
}

/// After the stages: shock indicator, time-step limits of groups [first, last).
template <int Dim, class Configuration>
void after_stages(Patch& patch, const GatherViews& view, const SweepSettings& s, int first,
                  int last, ReadView rate, bool indicator) {
  const GridGeometry& grid = *s.geometry;
  for (int g = first; g < last; ++g) {
    const Mask valid = first_lanes(patch.points.count() - kLanes * g);
    const Pack expansion = abs(rate(g)), c = view.sound_speed(g), signal = view.signal(g);
    if (indicator) view.indicator.set(g, select(c > Pack(0.0), expansion * grid.h / c, Pack(0.0)));
    Pack speed = 0.0;
    Pack fastest = signal;
    if constexpr (Configuration::fixed) {  // theory 12: h times the smallest stretch, no travel
      const ReadView F = reading(view.map);
      fastest = signal * sqrt(inverse_stretch_squared(inverse_map<Dim>(F, g)));
      const double strain = hmax(select(valid, stretch_measure<Dim>(F, g), Pack(0.0)));
      if (strain > patch.result.stretch) patch.result.stretch = strain;
    } else {
      for (int a = 0; a < Dim; ++a) speed = max(speed, abs(view.velocity(g, a)));
    }
    note_limit(patch.result, fastest * grid.inv_h, 0, g, valid);
    note_limit(patch.result, speed * (grid.inv_h * (1 / kMostTravel)), 1, g, valid);
    note_limit(patch.result, expansion * (1 / kMostDilatation), 2, g, valid);
  }
}

}  // namespace krater::inline KRATER_ISA
