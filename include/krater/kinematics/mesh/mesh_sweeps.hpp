// SPDX-License-Identifier: GPL-3.0-or-later
/// \file kinematics/mesh/mesh_sweeps.hpp
/// One step of the elements of a body, on the geometry of element_shapes.hpp. With v+ = v- + dv and
/// vm = v- + dv/2 of the nodes, at x_n:
///   W = dt V sigma : L(vm) = - dt sum f_I . vm_I         work of the very forces, to round-off
///   e <- e + W/m + sum_I m_eI k_I/m                      k: heat of walls at the nodes
///   f = I + dt L(v+),  r = V_{n+1}/(V_n det f),  a = 2 (r - 1)/(r + 1)
/// a goes to the kinematics stage as ExtraDilatation, whose density is then m/V_{n+1} exactly: det
/// f alone is not, where corners move otherwise than linearly. e is that of t_{n+1/2}
/// (BatchData::energy_share 0), as in kinematics/mpm/ledger.hpp; nothing is lost on the way between
/// nodes and elements, so the sum over all elements closes.
/// While the group is in the cache its forces for the next step are found, at x_{n+1} and v+, as
/// find_forces() would from the nodes, bit for bit: corners move as nodes do.
#pragma once

#include "krater/core/lane_math.hpp"
#include "krater/kinematics/mesh/element_shapes.hpp"
#include "krater/kinematics/note_rate.hpp"

namespace krater::inline KRATER_ISA {

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

/// The forces of a group at its corners: per element corner by corner, components and padding.
template <int Dim>
KRATER_FORCE_INLINE void store_forces(const ElementData& d, int g,
                                      const Pack (&f)[corner_nodes(Dim)][Dim]) {
  constexpr int N = corner_nodes(Dim), at_once = 8 / kForceDoubles<Dim>;
  for (int I = 0; I < N; I += at_once) {
    Pack r[8];
    for (int k = 0; k < 8; ++k) {
      const int i = k % kForceDoubles<Dim>;
      r[k] = i < Dim ? f[I + k / kForceDoubles<Dim>][i] : Pack(0.0);
    }
    transpose8(r);
    for (int l = 0; l < kLanes; ++l)
      store(d.forces + ((g * kLanes + l) * N + I) * kForceDoubles<Dim>, r[l]);
  }
}

/// Stable and viscous length of a group.
struct Lengths {
  Pack stable, viscous;
};

/// Forces, and the step of an element in its stiffest motion, of frequency 2 c_L/l, damped by xi =
/// Q/c_L:
///   dt = l/(Q + sqrt(Q^2 + c_L^2)),   Q = L/l (q_lin c + 2 q_quad L |tr D|),
/// L the length of the viscosity.
template <Holding Kind, class Shape>
KRATER_FORCE_INLINE void find_group_forces(const ElementData& d, const ElementViews& view, int g,
                                           Shape& shape, const Corners<Shape::D>& at,
                                           const Lengths& length, ElementResult& out) {
  const Pack rho = view.density(g), c = view.sound_speed(g);
  typename Shape::Values f;
  shape.template forces<Kind>(d, g, at, whole_stress(view, g), rho * c, f);
  store_forces<Shape::D>(d, g, f);
  double* remembered = d.remembered + kRemembered * kLanes * g;
  const Pack G = load(remembered), tr_D = load(remembered + kLanes);
  const Pack closing = max(Pack(0.0), -tr_D);
  const Pack Qv = select(
      closing > Pack(0.0),
      length.viscous / length.stable * fma((2.0 * d.q_quad) * length.viscous, closing, d.q_lin * c),
      Pack(0.0));
  const Pack c_L_squared = fma(c, c, (4.0 / 3.0) * G / rho);
  const Pack rate = (Qv + sqrt(fma(Qv, Qv, c_L_squared))) / length.stable;
  store(remembered + 2 * kLanes, rate);
  note_rate(d.count, rate, 0, g, out);
  note_rate(d.count, abs(tr_D) * (1 / kMostDilatation), 2, g, out);
}

template <class Shape>
KRATER_FORCE_INLINE Lengths lengths_of(const Shape& shape, const Pack (&share)[Shape::N],
                                       Pack measure) {
  Pack mass = 0.0;
  for (const Pack& m : share) mass = mass + m;
  const Pack stable = shape.stable(share, mass / shape.volume());
  return {stable, viscous_length<Shape::D>(measure, stable)};
}

template <class Frame, Holding Kind, ElementReference On>
void find_forces(const ElementData& d, int first, int last, ElementResult& out) {
  using Shape = typename ShapeOf<Frame, On>::type;
  constexpr int D = Frame::dim;
  alignas(64) static constexpr double zeros[9 * kLanes] = {};  // of the widest column
  const ElementViews view = views_of(d, zeros);
  for (int g = first; g < last; ++g) {
    Corners<D> at;
    load_corners<D>(d, g, false, at);
    Pack share[Shape::N];
    load_shares<D>(d, g, share);
    Shape shape;
    shape.place(d, g, at.x);
    find_group_forces<Kind>(d, view, g, shape, at,
                            lengths_of(shape, share, plane_measure(at.x, shape.volume())), out);
  }
}

/// What is kept of a group between strain and the end of the stages.
struct Kept {
  static constexpr int rates = 0, per_a = 12, volume = 15, plastic = 16, squares = 17, lengths = 18,
                       shape = 20;  // as the shape keeps itself
};

/// A group's volume before, and which it is, of the body and of those that the stages work on.
struct GroupPlace {
  Pack volume;
  int g, local;
};

/// Where the corners are now: exact volume, lengths, and the place and velocity of the whole.
template <Holding Kind, class Shape>
KRATER_FORCE_INLINE void move_group(const ElementData& d, const ElementScratch& w,
                                    const ElementViews& view, const Mat3<Pack>& dtL,
                                    const GroupPlace& was, const Pack (&share)[Shape::N],
                                    const Shape& shape, const Corners<Shape::D>& at) {
  constexpr int D = Shape::D, N = Shape::N;
  double* record = w.local + was.local * d.columns.local_stride;
  store_mat3(WriteView{record + d.columns.local_gradient, 0}, 0, dtL);
  Pack extra = 0.0;  // on another reference det f is the ratio
  if constexpr (Shape::current) {
    const Pack det_f = det_minus_one(dtL) + 1.0, ratio = shape.volume() / (was.volume * det_f);
    extra = 2.0 * (ratio - 1.0) / (ratio + 1.0);
  }
  store(record + d.columns.local_extra, extra);
  const Lengths length = lengths_of(shape, share, plane_measure(at.x, shape.volume()));
  store(w.length + was.local * kLanes, length.viscous);
  double* kept = w.kept + was.local * kKeptPacks * kLanes;
  store(kept + Kept::lengths * kLanes, length.stable);
  store(kept + (Kept::lengths + 1) * kLanes, length.viscous);
  shape.template keep<Kind>(at, kept + Kept::shape * kLanes);
  Pack mass = 0.0;
  for (const Pack& m : share) mass = mass + m;
  const Pack per_mass = 1.0 / mass;
  for (int i = 0; i < D; ++i) {
    Pack x = 0.0, v = 0.0;
    for (int I = 0; I < N; ++I) {
      x = x + at.x[I][i];
      v = fma(share[I], at.v[I][i], v);
    }
    view.position.set(was.g, i, (1.0 / N) * x);
    view.velocity.set(was.g, i, per_mass * v);
  }
}

/// After the stages: the forces of the next step, on a new reference where that is due.
template <class Frame, Holding Kind, ElementReference On>
KRATER_FORCE_INLINE void find_next_forces(const ElementData& d, const double* kept,
                                          const ElementViews& view, int g, ElementResult& out) {
  using Shape = typename ShapeOf<Frame, On>::type;
  constexpr int D = Frame::dim, N = corner_nodes(D);
  Corners<D> at;
  Shape shape;
  shape.template take<Kind>(d, g, kept + Kept::shape * kLanes, at);
  Lengths length{load(kept + Kept::lengths * kLanes), load(kept + (Kept::lengths + 1) * kLanes)};
  if constexpr (!Shape::current) {
    const Mask renewed = d.reference == ElementReference::adaptive
                             ? shape.template renew<Kind>(d, g, at.x)
                             : Pack(0.0) > Pack(0.0);
    if (bits(renewed) != 0) {
      out.renewed += __builtin_popcount(bits(renewed & first_lanes(d.count - kLanes * g)));
      shape.place(d, g, at.x);
      Pack share[N];
      load_shares<D>(d, g, share);
      length = lengths_of(shape, share, plane_measure(at.x, shape.volume()));
    }
  }
  find_group_forces<Kind>(d, view, g, shape, at, length, out);
}

/// Before the stages: work into e, strain, density, and where the corners go.
template <class Frame, Holding Kind, ElementReference On>
KRATER_FORCE_INLINE void strain_group(const ElementData& d, const ElementScratch& w,
                                      const ElementViews& view, double dt, int g, int local) {
  using Shape = typename ShapeOf<Frame, On>::type;
  constexpr int D = Frame::dim, N = corner_nodes(D);
  Corners<D> at;
  load_corners<D>(d, g, true, at);
  Pack share[N], heat = 0.0, mass = 0.0;
  load_shares<D>(d, g, share);
  for (int I = 0; I < N; ++I) {
    heat = fma(share[I], at.heat[I], heat);
    mass = mass + share[I];
  }
  Shape shape;
  shape.place(d, g, at.x);
  typename Shape::Motion before, change, middle, after;
  Shape::find_motion(at.v, before);
  Shape::find_motion(at.dv, change);
  Shape::add(0.5, change, before, middle);
  Shape::add(1.0, change, before, after);
  const Pack volume = shape.volume(), per_volume = 1.0 / volume;
  const Mat3<Pack> L_middle = shape.gradient(middle, per_volume);
  const Pack held = shape.template power<Kind>(d, g, at, before, middle, L_middle,
                                               view.density(g) * view.sound_speed(g));
  const Pack work = dt * volume * contract(whole_stress(view, g), sym(L_middle));
  view.energy.set(g, view.energy(g) + (work + heat) / mass);
  double* energy = d.hourglass_energy + kLanes * g;
  store(energy, fma(Pack(dt), held, load(energy)));

  const Mat3<Pack> dtL = shape.gradient(after, dt * per_volume);
  double* kept = w.kept + local * kKeptPacks * kLanes;
  if constexpr (keeps(Kind)) {
    shape.begin_modes(at, after, dtL, dt);
    for (int k = 0; k < D; ++k) store(kept + (Kept::per_a + k) * kLanes, shape.per_length()[k]);
    store(kept + Kept::volume * kLanes, shape.reference_volume());
    store(kept + Kept::plastic * kLanes, view.plastic(g));
    if constexpr (Kind == Holding::stiffness) store(kept + Kept::squares * kLanes, shape.squares());
  }
  for (int I = 0; I < N; ++I)
    for (int i = 0; i < D; ++i) {
      at.v[I][i] = at.v[I][i] + at.dv[I][i];
      at.x[I][i] = at.x[I][i] + dt * at.v[I][i];  // as the node
    }
  shape.place_again(at.x);
  move_group<Kind>(d, w, view, dtL, {volume, g, local}, share, shape, at);
  if constexpr (keeps(Kind)) {
    shape.end_modes(at);
    for (int k = 0; k < Shape::size; ++k) store(kept + (Kept::rates + k) * kLanes, shape.moved[k]);
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
      find_next_forces<Frame, Kind, On>(d, w.kept + (g - from) * kKeptPacks * kLanes, view, g, out);
      const Mask valid = first_lanes(d.count - kLanes * g);
      out.internal += sum(view.mass(g) * view.energy(g));
      out.hourglass += sum(select(valid, load(d.hourglass_energy + kLanes * g), Pack(0.0)));
    }
  }
}

}  // namespace krater::inline KRATER_ISA
