// SPDX-License-Identifier: GPL-3.0-or-later
/// \file kinematics/mesh/mesh_sweeps.hpp
/// One step of the elements of a body, on the geometry of placed_element.hpp. With v+ = v- + dv and
/// vm = v- + dv/2 of the nodes, at x_n:
///   W = dt V sigma : L(vm) = - dt sum f_I . vm_I         work of the very forces, to round-off
///   e <- e + W/m + sum_I m_eI k_I/m                      k: heat of walls at the nodes
///   f = I + dt L(v+),  r = V_{n+1}/(V_n det f),  a = 2 (r - 1)/(r + 1)
/// a goes to the kinematics stage as ExtraDilatation, whose density is then m/V_{n+1} exactly: det
/// f alone is not, where corners move otherwise than linearly. e is that of t_{n+1/2}
/// (BatchData::energy_share 0), as in kinematics/mpm/ledger.hpp; nothing is lost on the way between
/// nodes and elements, so the sum over all elements closes.
#pragma once

#include "krater/core/lane_math.hpp"
#include "krater/core/stability.hpp"
#include "krater/kinematics/mesh/mesh_kernels.hpp"
#include "krater/kinematics/mesh/placed_element.hpp"
#include "krater/materials/batch_access.hpp"

namespace krater::inline KRATER_ISA {

template <int Dim>
struct Corners {
  static constexpr int nodes = corner_nodes(Dim);
  Pack x[nodes][Dim], v[nodes][Dim], dv[nodes][Dim], heat[nodes];
};

template <int Dim>
KRATER_FORCE_INLINE void load_corners(const ElementData& d, int g, bool change, Corners<Dim>& out) {
  constexpr int N = corner_nodes(Dim);
  for (int I = 0; I < N; ++I) {
    const std::int32_t* lanes = d.corners + (N * g + I) * kLanes;
    Pack r[8];
    for (int l = 0; l < kLanes; ++l) r[l] = load(d.nodes + 8 * lanes[l]);
    transpose8(r);
    for (int a = 0; a < Dim; ++a) {
      out.x[I][a] = r[a];
      out.v[I][a] = r[4 + a];
    }
    out.heat[I] = r[7];
    if (!change) continue;
    for (int l = 0; l < kLanes; ++l) r[l] = loadu(d.changes + 4 * lanes[l]);
    transpose8(r);
    for (int a = 0; a < Dim; ++a) out.dv[I][a] = r[a];
  }
}

/// The geometry of the corners x, and what it was carried from.
template <class Frame, ElementReference On>
KRATER_FORCE_INLINE void place(const ElementData& d, int g,
                               const Pack (&x)[corner_nodes(Frame::dim)][Frame::dim],
                               ReferenceElement<Frame>& r, ElementGeometry<Pack, Frame>& e) {
  if constexpr (On == ElementReference::current) {
    find_geometry(x, e);
  } else {
    constexpr int N = corner_nodes(Frame::dim);
    for (int I = 0; I < N; ++I) {
      const std::int32_t* lanes = d.corners + (N * g + I) * kLanes;
      Pack at[8];
      for (int l = 0; l < kLanes; ++l) at[l] = loadu(d.start + 4 * lanes[l]);
      transpose8(at);
      for (int a = 0; a < Frame::dim; ++a) r.X[I][a] = at[a];
    }
    find_geometry(r.X, r.start);
    carry(x, r, e);
  }
}

/// Columns of the groups from `first` on.
struct ElementViews {
  WriteView position, velocity, energy;
  ReadView mass, density, stress, pressure, viscous, sound_speed, plastic, failed;
};
KRATER_FORCE_INLINE ElementViews views_of(const ElementData& d, const double* zeros) {
  const ElementColumns& c = d.columns;
  const auto read = [&](int offset) {
    return offset < 0 ? ReadView{zeros, 0} : ReadView{d.elements + offset, c.stride};
  };
  const auto write = [&](int offset) { return WriteView{d.elements + offset, c.stride}; };
  return {write(c.position),   write(c.velocity), write(c.energy),  read(c.mass),
          read(c.density),     read(c.stress),    read(c.pressure), read(c.viscous),
          read(c.sound_speed), read(c.plastic),   read(c.failed)};
}

KRATER_FORCE_INLINE Sym3<Pack> whole_stress(const ElementViews& v, int g) {
  Sym3<Pack> s = load_sym3(v.stress, g);
  const Pack p = v.pressure(g) + v.viscous(g);
  s.xx = s.xx - p;
  s.yy = s.yy - p;
  s.zz = s.zz - p;
  return s;
}

template <int Dim>
KRATER_FORCE_INLINE void load_shares(const ElementData& d, int g, Pack (&out)[corner_nodes(Dim)]) {
  for (int I = 0; I < corner_nodes(Dim); ++I)
    out[I] = load(d.shares + (corner_nodes(Dim) * g + I) * kLanes);
}

/// Viscous hourglass: f = - c_h/4 rho c S (sum_K G_K v_K) G_I, G = N gamma, S the area of a face.
template <class Frame>
KRATER_FORCE_INLINE void add_viscous_hourglass(const HourglassFrame<Pack, Frame::dim>& h,
                                               const Corners<Frame::dim>& at, Pack strength,
                                               Pack (&f)[corner_nodes(Frame::dim)][Frame::dim]) {
  constexpr int D = Frame::dim, N = corner_nodes(D);
  for (int a = 0; a < hourglass_modes(D); ++a)
    for (int i = 0; i < D; ++i) {
      Pack sum = 0.0;
      for (int I = 0; I < N; ++I) sum = fma(h.gamma[a][I], at.v[I][i] - at.v[0][i], sum);
      for (int I = 0; I < N; ++I) f[I][i] = fnma(strength * sum, h.gamma[a][I], f[I][i]);
    }
}

using Holding = HourglassOptions::Kind;
/// Stress Q that is kept, in place of dampers.
constexpr bool keeps(Holding kind) { return kind != Holding::viscous; }

/// Forces that hold the hourglass modes, at the corners as they are.
template <class Frame, Holding Kind, ElementReference On>
KRATER_FORCE_INLINE void add_hourglass(const ElementData& d, const ElementGeometry<Pack, Frame>& e,
                                       const ReferenceElement<Frame>& r,
                                       const Corners<Frame::dim>& at, Pack rho_c, int g,
                                       HourglassFrame<Pack, Frame::dim>& h,
                                       Pack (&f)[corner_nodes(Frame::dim)][Frame::dim]) {
  constexpr int D = Frame::dim, N = corner_nodes(D), size = hourglass_size(D);
  if constexpr (keeps(Kind)) {
    Pack Q[size];
    for (int k = 0; k < size; ++k) Q[k] = load(d.hourglass + (size * g + k) * kLanes);
    if constexpr (On == ElementReference::current) {
      find_hourglass(e, at.x, h);
      add_hourglass_force<Pack, D>(h, Q, f);
    } else {
      find_hourglass(r.start, r.X, h);
      add_pulled_force(h, r, at.x, Q, f);
    }
  } else {
    ElementGeometry<Pack, Frame> now = e;
    if constexpr (On == ElementReference::initial)
      find_geometry(at.x, now);  // dampers know no start
    find_hourglass(now, at.x, h);
    const Pack measure = plane_measure(at.x, e.volume);
    const Pack face = D == 3 ? measure * rcbrt(measure) : e.volume / sqrt(measure);
    add_viscous_hourglass<Frame>(h, at, 0.25 * d.held.viscous * N * N * rho_c * face, f);
  }
}

KRATER_FORCE_INLINE void note_rate(const ElementData& d, Pack rate, int kind, int g,
                                   ElementResult& out) {
  const Pack valid = select(first_lanes(d.count - kLanes * g), rate, Pack(0.0));
  if (!(hmax(valid) > out.max_rate)) return;
  for (int l = 0; l < kLanes; ++l)
    if (get(valid, l) > out.max_rate) {
      out.max_rate = get(valid, l);
      out.limiter = kind;
      out.limiting = kLanes * g + l;
    }
}

/// Length of the viscosity: of the whole element, that waves along a flat one see it too, but no
/// more than twice the stable one: across a flat element its damping would else demand a step that
/// falls with the square of the thickness.
template <class Frame>
KRATER_FORCE_INLINE Pack viscous_length(const ElementGeometry<Pack, Frame>& e,
                                        const Pack (&x)[corner_nodes(Frame::dim)][Frame::dim],
                                        Pack stable) {
  const Pack measure = plane_measure(x, e.volume);
  const Pack whole = Frame::dim == 3 ? measure * rcbrt(measure) * rcbrt(measure) : sqrt(measure);
  return min(whole, 2.0 * stable);
}

/// The step of an element in its stiffest motion, of frequency 2 c_L/l, damped by xi = Q/c_L:
///   dt = l/(Q + sqrt(Q^2 + c_L^2)),   Q = L/l (q_lin c + 2 q_quad L |tr D|),
/// L the length of the viscosity.
template <class Frame, Holding Kind, ElementReference On>
void find_forces(const ElementData& d, int first, int last, ElementResult& out) {
  constexpr int D = Frame::dim, N = corner_nodes(D);
  alignas(64) static constexpr double zeros[kLanes] = {};
  const ElementViews view = views_of(d, zeros);
  for (int g = first; g < last; ++g) {
    Corners<D> at;
    load_corners<D>(d, g, false, at);
    ElementGeometry<Pack, Frame> e;
    ReferenceElement<Frame> r;
    place<Frame, On>(d, g, at.x, r, e);
    Pack f[N][D];
    for (auto& corner : f)
      for (Pack& component : corner) component = 0.0;
    add_stress_force(e, whole_stress(view, g), f);
    const Pack rho = view.density(g), c = view.sound_speed(g);
    HourglassFrame<Pack, D> h;
    add_hourglass<Frame, Kind, On>(d, e, r, at, rho * c, g, h, f);
    for (int I = 0; I < N; ++I)
      for (int i = 0; i < D; ++i) store(d.forces + ((N * g + I) * D + i) * kLanes, f[I][i]);
    Pack share[N];
    load_shares<D>(d, g, share);
    double* remembered = d.remembered + kRemembered * kLanes * g;
    const Pack length = stable_length(e, share, rho), G = load(remembered),
               tr_D = load(remembered + kLanes);
    const Pack closing = max(Pack(0.0), -tr_D), viscous = viscous_length<Frame>(e, at.x, length);
    const Pack Qv =
        select(closing > Pack(0.0),
               viscous / length * fma((2.0 * d.q_quad) * viscous, closing, d.q_lin * c), Pack(0.0));
    const Pack c_L_squared = fma(c, c, (4.0 / 3.0) * G / rho);
    const Pack rate = (Qv + sqrt(fma(Qv, Qv, c_L_squared))) / length;
    store(remembered + 2 * kLanes, rate);
    note_rate(d, rate, 0, g, out);
    note_rate(d, abs(tr_D) * (1 / kMostDilatation), 2, g, out);
  }
}

/// What is kept of a group between strain and the end of the stages.
struct Kept {
  static constexpr int rates = 0, per_a = 12, volume = 15, plastic = 16, squares = 17;
};

/// The step's map of a group, its volume before, and which group it is, of the body and of those
/// that the stages work on.
struct StepMap {
  Mat3<Pack> dtL;
  Pack volume;
  double dt;
  int g, local;
};

/// Where the corners go: exact volume, length, and the place and velocity of the whole.
template <class Frame, ElementReference On>
KRATER_FORCE_INLINE void move_group(const ElementData& d, const ElementScratch& w,
                                    const ElementViews& view, const StepMap& map,
                                    const Pack (&share)[corner_nodes(Frame::dim)],
                                    Corners<Frame::dim>& at, ReferenceElement<Frame>& r) {
  constexpr int D = Frame::dim, N = corner_nodes(D);
  const int g = map.g, local = map.local;
  for (int I = 0; I < N; ++I)
    for (int i = 0; i < D; ++i) at.x[I][i] = fma(Pack(map.dt), at.v[I][i], at.x[I][i]);
  ElementGeometry<Pack, Frame> after;
  if constexpr (On == ElementReference::current)
    find_geometry(at.x, after);
  else
    carry(at.x, r, after);
  double* record = w.local + local * d.columns.local_stride;
  store_mat3(WriteView{record + d.columns.local_gradient, 0}, 0, map.dtL);
  Pack extra = 0.0;  // on the initial reference det f is the ratio
  if constexpr (On == ElementReference::current) {
    const Pack det_f = det_minus_one(map.dtL) + 1.0, ratio = after.volume / (map.volume * det_f);
    extra = 2.0 * (ratio - 1.0) / (ratio + 1.0);
  }
  store(record + d.columns.local_extra, extra);
  Pack mass = 0.0;
  for (const Pack& m : share) mass = mass + m;
  store(w.length + local * kLanes,
        viscous_length<Frame>(after, at.x, stable_length(after, share, mass / after.volume)));
  for (int i = 0; i < D; ++i) {
    Pack x = 0.0, v = 0.0;
    for (int I = 0; I < N; ++I) {
      x = x + at.x[I][i];
      v = fma(share[I], at.v[I][i], v);
    }
    view.position.set(g, i, (1.0 / N) * x);
    view.velocity.set(g, i, v / mass);
  }
}

/// Before the stages: work into e, strain, density.
template <class Frame, Holding Kind, ElementReference On>
KRATER_FORCE_INLINE void strain_group(const ElementData& d, const ElementScratch& w,
                                      const ElementViews& view, double dt, int g, int local) {
  constexpr int D = Frame::dim, N = corner_nodes(D), size = hourglass_size(D);
  Corners<D> at;
  load_corners<D>(d, g, true, at);
  Pack share[N];
  load_shares<D>(d, g, share);
  ElementGeometry<Pack, Frame> e;
  ReferenceElement<Frame> r;
  place<Frame, On>(d, g, at.x, r, e);
  HourglassFrame<Pack, D> h;
  Pack f[N][D];
  for (auto& corner : f)
    for (Pack& component : corner) component = 0.0;
  const Pack c = view.sound_speed(g);
  add_hourglass<Frame, Kind, On>(d, e, r, at, view.density(g) * c, g, h,
                                 f);  // of the v- that it was found with
  Pack heat = 0.0, held = 0.0, middle[N][D], mass = 0.0;
  for (int I = 0; I < N; ++I) {
    heat = fma(share[I], at.heat[I], heat);
    mass = mass + share[I];
    for (int i = 0; i < D; ++i) {
      middle[I][i] = fma(Pack(0.5), at.dv[I][i], at.v[I][i]);
      held = fnma(f[I][i], middle[I][i] - middle[0][i], held);
      at.v[I][i] = at.v[I][i] + at.dv[I][i];
    }
  }
  const Pack per_volume = 1.0 / e.volume;
  const Sym3<Pack> D_middle = sym(mean_gradient(e, middle, per_volume));
  const Pack work = dt * e.volume * contract(whole_stress(view, g), D_middle);
  view.energy.set(g, view.energy(g) + (work + heat) / mass);
  double* energy = d.hourglass_energy + kLanes * g;
  store(energy, fma(Pack(dt), held, load(energy)));

  const Mat3<Pack> dtL = mean_gradient(e, at.v, dt * per_volume);
  double* kept = w.kept + local * kKeptPacks * kLanes;
  Pack modes[hourglass_modes(D)][D], before[size];
  if constexpr (keeps(Kind)) {
    if constexpr (On == ElementReference::current) {
      Pack q[size];
      hourglass_rates<Pack, D>(h, at.v, q);
      for (int k = 0; k < size; ++k) store(kept + (Kept::rates + k) * kLanes, dt * q[k]);
    } else {
      pulled_modes(h, r, at.x, modes, before);
    }
    for (int k = 0; k < D; ++k) store(kept + (Kept::per_a + k) * kLanes, h.per_a[k]);
    store(kept + Kept::volume * kLanes,
          On == ElementReference::current ? e.volume : r.start.volume);
    store(kept + Kept::plastic * kLanes, view.plastic(g));
    if constexpr (Kind == Holding::stiffness)
      store(kept + Kept::squares * kLanes,
            squares_of(On == ElementReference::current ? e : r.start));
  }
  move_group<Frame, On>(d, w, view, {dtL, e.volume, dt, g, local}, share, at, r);
  if constexpr (keeps(Kind) && On == ElementReference::initial) {
    Pack after[size];
    pulled_modes(h, r, at.x, modes, after);
    for (int k = 0; k < size; ++k) store(kept + (Kept::rates + k) * kLanes, after[k] - before[k]);
  }
}

/// After the stages: Q <- s (Q + dQ), s = q/(q + 3 G d eps) of the radial return; nothing of failed
/// matter.
template <int Dim, Holding Kind>
KRATER_FORCE_INLINE void stress_hourglass(const ElementData& d, const double* kept,
                                          const ElementViews& view, Pack G, int g) {
  constexpr int size = hourglass_size(Dim);
  HourglassFrame<Pack, Dim> h;
  Pack dq[size], Q[size];
  double* record = d.hourglass + size * kLanes * g;
  for (int k = 0; k < size; ++k) {
    dq[k] = load(kept + (Kept::rates + k) * kLanes);
    Q[k] = load(record + k * kLanes);
  }
  for (int k = 0; k < Dim; ++k) h.per_a[k] = load(kept + (Kept::per_a + k) * kLanes);
  const Pack volume = load(kept + Kept::volume * kLanes);
  if constexpr (Kind == Holding::stiffness) {
    add_hourglass_stiffness<Pack, Dim>(dq, G, d.held.stiffness, load(kept + Kept::squares * kLanes),
                                       volume, Q);
  } else {
    const Pack c = view.sound_speed(g), K = view.density(g) * c * c;
    const Pack nu = min(Pack(0.4999), fnma(Pack(2.0), G, 3.0 * K) / (2.0 * fma(Pack(3.0), K, G)));
    add_hourglass_stress<Pack, Dim>(h, dq, G, nu, volume, Q);
  }
  const Sym3<Pack> s = load_sym3(view.stress, g);
  const Pack q = sqrt(1.5 * contract(s, s)),
             flow = 3.0 * G * (view.plastic(g) - load(kept + Kept::plastic * kLanes));
  Pack scale = select(flow > Pack(0.0), q / (q + flow), Pack(1.0));
  scale = select(view.failed(g) > Pack(0.5), Pack(0.0), scale);
  for (int k = 0; k < size; ++k) store(record + k * kLanes, scale * Q[k]);
}

template <class Frame, Holding Kind, ElementReference On>
void strain_elements(const ElementData& d, const ElementScratch& w, double dt, int first, int last,
                     ElementResult& out) {
  constexpr int D = Frame::dim;
  const ElementViews view = views_of(d, w.zeros);
  const ElementColumns& c = d.columns;
  for (int from = first; from < last; from += kElementGroups) {
    const int to = from + kElementGroups < last ? from + kElementGroups : last;
    for (int g = from; g < to; ++g) {
      out.hourglass_before += sum(select(first_lanes(d.count - kLanes * g),
                                         load(d.hourglass_energy + kLanes * g), Pack(0.0)));
      strain_group<Frame, Kind, On>(d, w, view, dt, g, g - from);
    }
    const BatchData batch{.state = d.elements + from * c.stride,
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
      store(d.remembered + kRemembered * kLanes * g, G);
      store(d.remembered + (kRemembered * g + 1) * kLanes, load(record + c.local_rate));
      if constexpr (keeps(Kind))
        stress_hourglass<D, Kind>(d, w.kept + (g - from) * kKeptPacks * kLanes, view, G, g);
      const Mask valid = first_lanes(d.count - kLanes * g);
      out.internal += sum(view.mass(g) * view.energy(g));
      out.hourglass += sum(select(valid, load(d.hourglass_energy + kLanes * g), Pack(0.0)));
    }
  }
}

}  // namespace krater::inline KRATER_ISA
