// SPDX-License-Identifier: GPL-3.0-or-later
/// \file kinematics/sph/sph_sweeps.hpp
/// One step of the particles of a body (kinematics/sph/correction.hpp). With v+ = v- + dv and
///   N(v) = sum_j V_j (v_j - v_i) (x) grad W_ij   over the places of the reference,
///   current  L = N K,                    S = sigma,                  V the volume now
///   initial  F' = N K, L = F' F^-1,      S = (V/V0) sigma F^-T,      V0 that of the start
/// and adaptive, the same: X <- x, V0 <- V, F <- 1 of all particles of a body when the greatest
/// component of |F^T F - 1|/2 passes a bound; columns and energies stay as they are.
///   A_i = S_i K_i,   f_i = sum_j V_i V_j (A_i + A_j) grad W_ij
///   W_i = dt V sigma : (L(v-) + L(v+))/2,   sum_i W_i = - dt sum_i f_i . (v- + v+)/2 to round-off
///   e <- e + W/m + heat of sides,   f = I + dt L(v+), rho by det f,   x <- x + dt v+
/// What gradients do not see is held by a viscosity of pairs along their line e = x_ij/|x_ij|:
///   h_i = z/2 sum_j V_i V_j W' (Z_i + Z_j) [v_ij.e - x_ij.(D_i + D_j) e/2] e,   Z = rho c,
/// x_ij the places now, all of v-. With z = 1 that is the pressure between two states that differ
/// by what linear reconstruction leaves, in the acoustic Riemann problem of the pair (Parshikov and
/// Medin 2002; Vila 1999), of no effect on a linear field of velocity. On `current` pairs in
/// tension clump (Swegle, Hicks and Attaway 1995). Of the tension of a pair along its line,
///   t = e.(A_i + A_j) e > 0,   a part min(1, eps (W_ij/W(dx))^4)
/// is taken back where eps > 0 is asked for (artificial stress of Gray, Monaghan and Swift 2001,
/// who take 0.3; their powers of principal stresses push pairs apart that plastic flow brought
/// close). It softens tension, and feeds the motion of particles that are not in order. Both
/// forces are along x_ij, so that momenta are exact. Their work heats both alike: half of
/// - h_ij.v_ij-, and - h_i.dv_i/2 of each, in sum - h.(v- + v+)/2.
/// A pair gives both its particles the same force to the last bit, by its sign. e is that of
/// t_{n+1/2} (BatchData::energy_share 0), as of elements (kinematics/mesh/mesh_sweeps.hpp).
#pragma once

#include "krater/kinematics/sph/sph_lanes.hpp"
#include "krater/kinematics/sph/sph_limits.hpp"
#include "krater/kinematics/sph/weights.hpp"

namespace krater::inline KRATER_ISA {

/// The sweeps for one dimension, weight and reference.
template <int Dim, SphKernel Kind, SphReference Reference>
class Sweeps final : public SphKernels {
 public:
  void place(const SphData& d, bool ends, int first, int last) const override;
  void correct(const SphData& d, int first, int last, SphResult& out) const override;
  void forces(const SphData& d, int first, int last) const override;
  void show_unit(const SphData& d, int first, int last) const override;
  void strain(const SphData& d, const SphScratch& scratch, double dt, int first, int last,
              SphResult& out) const override;

 private:
  static constexpr bool fixed = Reference == SphReference::initial;
  template <bool Moments>
  static void sum_gradient(const SphData& d, const Own<Dim>& own, int g, Axes<Dim>& N,
                           SymAxes<Pack, Dim>& M);
  static constexpr LoadRecord at = load_record(Dim);
  template <class Load>
  static Pack tension_taken_back(const SphData& d, const WeightScale& scale, const Load& own,
                                 const Load& near, const Pack (&x)[Dim], Pack squared);
  template <bool Held, bool Eased>
  static void sum_forces(const SphData& d, int first, int last);
  static Mat3<Pack> on_reference(const SphData& d, const SphViews& view, const Mat3<Pack>& stress,
                                 int g);
  static Mat3<Pack> gradient(const SphData& d, const Axes<Dim>& N, const SymAxes<Pack, Dim>& K,
                             int g);
  static void strain_group(const SphData& d, const SphScratch& w, const SphViews& view, double dt,
                           int g, int local, SphResult& out);
};

/// Records of motion from the columns.
template <int Dim, SphKernel Kind, SphReference Reference>
void Sweeps<Dim, Kind, Reference>::place(const SphData& d, bool ends, int first, int last) const {
  alignas(64) static constexpr double zeros[9 * kLanes] = {};  // of the widest column
  const SphViews view = views_of(d, zeros);
  for (int g = first; g < last; ++g) {
    Pack change[4], r[8];
    for (Pack& p : r) p = 0.0;
    if (ends) load_changes(d, g, change);
    for (int a = 0; a < Dim; ++a) {
      r[a] = fixed ? load(d.reference + (3 * g + a) * kLanes) : view.position(g, a);
      r[4 + a] = ends ? view.velocity(g, a) + change[a] : view.velocity(g, a);
    }
    r[3] = fixed ? 1.0 / load(d.reference_density + kLanes * g) * view.mass(g)
                 : view.mass(g) / view.density(g);
    store_records(d.motion + kMotion * kLanes * g, kMotion, r);
  }
}

/// N, and M where it is asked for.
template <int Dim, SphKernel Kind, SphReference Reference>
template <bool Moments>
KRATER_FORCE_INLINE void Sweeps<Dim, Kind, Reference>::sum_gradient(const SphData& d,
                                                                    const Own<Dim>& own, int g,
                                                                    Axes<Dim>& N,
                                                                    SymAxes<Pack, Dim>& M) {
  const WeightScale scale = weight_scale<Kind>(Dim, d.h);
  N = zero_axes<Dim>();
  for (Pack& entry : M.c) entry = 0.0;
  const NeighbourRows& near = d.neighbours[g];
  for (int k = 0; k < near.count; ++k) {
    Pack r[8], x[Dim], squared = 0.0;
    gather_records(d.motion, kMotion, near.rows + kLanes * k, r);
    for (int a = 0; a < Dim; ++a) {
      x[a] = own.x[a] - r[a];
      squared = fma(x[a], x[a], squared);
    }
    const Pack w = r[3] * weight_slope<Kind>(scale, squared, inverse_distance(squared));
    for (int b = 0; b < Dim; ++b) {
      const Pack along = w * x[b];
      for (int a = 0; a < Dim; ++a) {
        N.c[a][b] = fma(r[4 + a] - own.v[a], along, N.c[a][b]);
        if constexpr (Moments)
          if (a >= b) M.c[M.place(a, b)] = fnma(along, x[a], M.c[M.place(a, b)]);
      }
    }
  }
}

/// L of the motion whose N is given.
template <int Dim, SphKernel Kind, SphReference Reference>
KRATER_FORCE_INLINE Mat3<Pack> Sweeps<Dim, Kind, Reference>::gradient(const SphData& d,
                                                                      const Axes<Dim>& N,
                                                                      const SymAxes<Pack, Dim>& K,
                                                                      int g) {
  const Mat3<Pack> rate = in_space<Dim>(times(N, K), Pack(0.0));
  if constexpr (fixed) return rate * inverse(load_deformation(d, g));
  (void)d;
  (void)g;
  return rate;
}

/// S of a stress.
template <int Dim, SphKernel Kind, SphReference Reference>
KRATER_FORCE_INLINE Mat3<Pack> Sweeps<Dim, Kind, Reference>::on_reference(const SphData& d,
                                                                          const SphViews& view,
                                                                          const Mat3<Pack>& stress,
                                                                          int g) {
  if constexpr (fixed)
    return (load(d.reference_density + kLanes * g) / view.density(g)) *
           (stress * transpose(inverse(load_deformation(d, g))));
  (void)d;
  (void)view;
  (void)g;
  return stress;
}

template <int Dim, SphKernel Kind, SphReference Reference>
void Sweeps<Dim, Kind, Reference>::correct(const SphData& d, int first, int last,
                                           SphResult& out) const {
  alignas(64) static constexpr double zeros[9 * kLanes] = {};  // of the widest column
  const SphViews view = views_of(d, zeros);
  for (int g = first; g < last; ++g) {
    const Own<Dim> own = load_own<Dim>(d, g);
    Axes<Dim> N;
    SymAxes<Pack, Dim> M, K;
    sum_gradient<true>(d, own, g, N, M);
    if (d.corrects) {
      Mask flat;
      K = corrected(M, flat);
      out.flat += __builtin_popcount(bits(flat & first_lanes(d.count - kLanes * g)));
    } else {
      for (int k = 0; k < K.size; ++k) K.c[k] = k < Dim ? 1.0 : 0.0;
    }
    for (int k = 0; k < K.size; ++k) store(d.correction + (6 * g + k) * kLanes, K.c[k]);
    const Sym3<Pack> sigma = whole_stress(view, g);
    const Mat3<Pack> L = gradient(d, N, K, g);
    store(d.power + kLanes * g, contract(sigma, sym(L)));
    const Axes<Dim> A = times(along_grid<Dim>(on_reference(d, view, as_matrix(sigma), g)), K);
    Pack r[at.size / 8][8];
    const auto put = [&r](int place, Pack value) { r[place / 8][place % 8] = value; };
    for (int k = 0; k < at.size; ++k) put(k, Pack(0.0));
    const Axes<Dim> rates = along_grid<Dim>(L);
    for (int a = 0; a < Dim; ++a) {
      put(a, own.x[a]);
      put(at.v + a, own.v[a]);
      put(at.now + a, view.position(g, a));
      for (int b = 0; b <= a; ++b)
        put(at.D + SymAxes<Pack, Dim>::place(a, b),
            a == b ? rates.c[a][a] : rates.c[a][b] + rates.c[b][a]);
    }
    put(3, own.volume);
    put(at.Z, view.density(g) * view.sound_speed(g));
    for (int k = 0; k < Dim * Dim; ++k) put(at.A + k, A.c[k / Dim][k % Dim]);
    double* to = d.load + at.size * kLanes * g;
    for (int line = 0; line < at.size / 8; ++line) store_records(to + 8 * line, at.size, r[line]);
    note_limits<Dim>(d, view, g, out);
  }
}

/// Of x_ij.(A_i + A_j) x_ij, where it pulls, a part eps (W_ij/W(dx))^4, at most all.
template <int Dim, SphKernel Kind, SphReference Reference>
template <class Load>
KRATER_FORCE_INLINE Pack Sweeps<Dim, Kind, Reference>::tension_taken_back(
    const SphData& d, const WeightScale& scale, const Load& own, const Load& near,
    const Pack (&x)[Dim], Pack squared) {
  Pack tension = 0.0;
  for (int a = 0; a < Dim; ++a)
    for (int b = 0; b < Dim; ++b) {
      const int A = at.A + Dim * a + b;
      tension = fma((own[A] + near[A]) * x[a], x[b], tension);
    }
  const double per_spacing = 1 / weight<Kind>(scale, d.spacing * d.spacing);
  const Pack close = per_spacing * weight<Kind>(scale, squared), closer = close * close;
  return min(Pack(1.0), d.artificial_stress * (closer * closer)) * max(Pack(0.0), tension);
}

template <int Dim, SphKernel Kind, SphReference Reference>
template <bool Held, bool Eased>
void Sweeps<Dim, Kind, Reference>::sum_forces(const SphData& d, int first, int last) {
  constexpr int lines = ((Held ? (fixed ? at.now + Dim : at.now) : at.v) + 7) / 8;
  const WeightScale scale = weight_scale<Kind>(Dim, d.h);
  const Pack damped = 0.5 * d.zero_energy;
  for (int g = first; g < last; ++g) {
    Loads<lines> own, near;
    gather_loads(d.load + at.size * kLanes * g, at.size, kOwnLanes, own);
    Pack f[Dim], held[Dim], heat = 0.0;
    for (int a = 0; a < Dim; ++a) f[a] = held[a] = 0.0;
    const NeighbourRows& list = d.neighbours[g];
    for (int k = 0; k < list.count; ++k) {
      gather_loads(d.load, at.size, list.rows + kLanes * k, near);
      Pack x[Dim], squared = 0.0;
      for (int a = 0; a < Dim; ++a) {
        x[a] = own[a] - near[a];
        squared = fma(x[a], x[a], squared);
      }
      Pack per_r = inverse_distance(squared);
      const Pack w = near[3] * weight_slope<Kind>(scale, squared, per_r);
      for (int b = 0; b < Dim; ++b) {
        const Pack along = w * x[b];
        for (int a = 0; a < Dim; ++a)
          f[a] = fma(own[at.A + Dim * a + b] + near[at.A + Dim * a + b], along, f[a]);
      }
      if constexpr (Held) {
        if constexpr (fixed) {
          Pack squared_now = 0.0;
          for (int a = 0; a < Dim; ++a) {
            x[a] = own[at.now + a] - near[at.now + a];
            squared_now = fma(x[a], x[a], squared_now);
          }
          per_r = inverse_distance(squared_now);
        }
        Pack parting = 0.0, linear = 0.0;  // v_ij.x_ij, x_ij.(D_i + D_j) x_ij
        for (int a = 0; a < Dim; ++a) {
          parting = fma(own[at.v + a] - near[at.v + a], x[a], parting);
          for (int b = 0; b <= a; ++b) {
            const int D = at.D + SymAxes<Pack, Dim>::place(a, b);
            linear = fma(own[D] + near[D], x[a] * x[b], linear);
          }
        }
        // Of a lane without a neighbour differences are zero, and w is not: they come first.
        const Pack left = fnma(Pack(0.5), linear, parting) * per_r;
        Pack pull = damped * (own[at.Z] + near[at.Z]) * left * w;
        if constexpr (Eased)
          pull =
              fnma(tension_taken_back(d, scale, own, near, x, squared) * (per_r * per_r), w, pull);
        for (int a = 0; a < Dim; ++a) held[a] = fma(pull, x[a], held[a]);
        heat = fnma(pull, parting, heat);
      }
    }
    const Pack strength = own[3];
    for (int a = 0; a < Dim; ++a) {
      store(d.held + (4 * g + a) * kLanes, strength * held[a]);
      store(d.force + (3 * g + a) * kLanes, fma(own[3], f[a], strength * held[a]));
    }
    store(d.held + (4 * g + 3) * kLanes, 0.5 * strength * heat);
  }
}

template <int Dim, SphKernel Kind, SphReference Reference>
void Sweeps<Dim, Kind, Reference>::forces(const SphData& d, int first, int last) const {
  if (!fixed && d.artificial_stress > 0)
    sum_forces<true, !fixed>(d, first, last);
  else if (d.zero_energy > 0)
    sum_forces<true, false>(d, first, last);
  else
    sum_forces<false, false>(d, first, last);
}

template <int Dim, SphKernel Kind, SphReference Reference>
void Sweeps<Dim, Kind, Reference>::show_unit(const SphData& d, int first, int last) const {
  alignas(64) static constexpr double zeros[9 * kLanes] = {};  // of the widest column
  const SphViews view = views_of(d, zeros);
  const Pack one = 1.0, none = 0.0;
  for (int g = first; g < last; ++g) {
    const Mat3<Pack> S =
        on_reference(d, view, {one, none, none, none, one, none, none, none, one}, g);
    const Axes<Dim> A = times(along_grid<Dim>(S), load_correction<Dim>(d, g));
    for (int k = 0; k < Dim * Dim; ++k)
      for (int l = 0; l < kLanes; ++l)
        d.load[at.size * (kLanes * g + l) + at.A + k] = get(A.c[k / Dim][k % Dim], l);
  }
}

/// Before the stages: work into e, strain, places.
template <int Dim, SphKernel Kind, SphReference Reference>
KRATER_FORCE_INLINE void Sweeps<Dim, Kind, Reference>::strain_group(const SphData& d,
                                                                    const SphScratch& w,
                                                                    const SphViews& view, double dt,
                                                                    int g, int local,
                                                                    SphResult& out) {
  const Own<Dim> own = load_own<Dim>(d, g);
  Axes<Dim> N;
  SymAxes<Pack, Dim> unused;
  sum_gradient<false>(d, own, g, N, unused);
  const SymAxes<Pack, Dim> K = load_correction<Dim>(d, g);
  const Mat3<Pack> L = gradient(d, N, K, g);
  const Sym3<Pack> sigma = whole_stress(view, g);
  const Pack power = 0.5 * (load(d.power + kLanes * g) + contract(sigma, sym(L)));
  Pack change[4], held = load(d.held + (4 * g + 3) * kLanes);
  load_changes(d, g, change);
  for (int a = 0; a < Dim; ++a)
    held = fnma(0.5 * load(d.held + (4 * g + a) * kLanes), change[a], held);
  out.held += dt * sum(select(first_lanes(d.count - kLanes * g), held, Pack(0.0)));
  const Pack mass = max(view.mass(g), Pack(1e-200));  // empty lanes have none
  view.energy.set(g, view.energy(g) + dt * power / view.density(g) + dt * held / mass + change[3]);
  const Mat3<Pack> dtL = Pack(dt) * L;
  double* record = w.local + local * d.columns.local_stride;
  store_mat3(WriteView{record + d.columns.local_gradient, 0}, 0, dtL);
  if constexpr (fixed) {
    const Mat3<Pack> F = load_deformation(d, g), dF = dtL * F;
    const Mat3<Pack> after{F.xx + dF.xx, F.xy + dF.xy, F.xz + dF.xz, F.yx + dF.yx, F.yy + dF.yy,
                           F.yz + dF.yz, F.zx + dF.zx, F.zy + dF.zy, F.zz + dF.zz};
    store_mat3(WriteView{d.deformation, 9 * kLanes}, g, after);
    note_stretch(after, first_lanes(d.count - kLanes * g), out);
  }
  const Pack j = det_minus_one(dtL) + 1.0;
  store(w.length + local * kLanes, particle_length<Dim>(d, j * view.mass(g) / view.density(g)));
  for (int a = 0; a < Dim; ++a) {
    view.velocity.set(g, a, own.v[a]);
    view.position.set(g, a, fma(Pack(dt), own.v[a], view.position(g, a)));
  }
}

template <int Dim, SphKernel Kind, SphReference Reference>
void Sweeps<Dim, Kind, Reference>::strain(const SphData& d, const SphScratch& w, double dt,
                                          int first, int last, SphResult& out) const {
  const SphViews view = views_of(d, w.zeros);
  const SphColumns& c = d.columns;
  for (int from = first; from < last; from += kSphGroups) {
    const int to = from + kSphGroups < last ? from + kSphGroups : last;
    for (int g = from; g < to; ++g) strain_group(d, w, view, dt, g, g - from, out);
    const BatchData batch{.state = d.particles + from * c.stride,
                          .state_stride = c.stride,
                          .local = w.local,
                          .local_stride = c.local_stride,
                          .zeros = w.zeros,
                          .groups = to - from,
                          .count = d.count - kLanes * from,
                          .first_group = from,
                          .dt = dt,
                          .length = w.length,
                          .length_stride = kLanes,
                          .ledger = &out.ledger,
                          .fault = &out.fault,
                          .energy_share = 0};
    for (int k = 0; k < d.stage_count; ++k) d.stages[k]->apply(batch);
    for (int g = from; g < to; ++g) {
      const double* record = w.local + (g - from) * c.local_stride;
      const Pack G = c.local_shear < 0 ? Pack(0.0) : load(record + c.local_shear);
      store(d.remembered + 2 * kLanes * g, G);
      store(d.remembered + (2 * g + 1) * kLanes, load(record + c.local_rate));
      out.internal += sum(view.mass(g) * view.energy(g));
    }
  }
}

}  // namespace krater::inline KRATER_ISA
