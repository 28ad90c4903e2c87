// SPDX-License-Identifier: GPL-3.0-or-later
/// \file kinematics/mesh/element_shapes.hpp
/// What the sweeps ask of an element, in one of two ways: by its corners (element.hpp,
/// placed_element.hpp: every frame and reference), or by its modes (hexahedron.hpp: 3d, on the
/// current reference, where there is most to save). Both have
///   place            geometry of the corners x
///   Motion, add      velocities, and v + s dv
///   gradient         s V L of a motion
///   stable_length, viscous_length
///   power            - sum f . v of what holds the hourglass, for v the middle of the step
///   forces           of stress and hourglass at the corners
///   begin, end_modes what the hourglass modes move by in a step, along the element's directions
///   keep, take       itself, and what its forces need of the corners, over the stages
#pragma once

#include "krater/core/simd_rows.hpp"
#include "krater/core/stability.hpp"
#include "krater/kinematics/mesh/hexahedron.hpp"
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
    load_rows([&](int l) { return d.nodes + 8 * lanes[l]; }, r);
    for (int a = 0; a < Dim; ++a) {
      out.x[I][a] = r[a];
      out.v[I][a] = r[4 + a];
    }
    out.heat[I] = r[7];
    if (!change) continue;
    load_columns([&](int l) { return d.changes + 4 * lanes[l]; }, 0, r);
    for (int a = 0; a < Dim; ++a) out.dv[I][a] = r[a];
  }
}

using Holding = HourglassOptions::Kind;
/// Stress Q that is kept, in place of dampers.
constexpr bool keeps(Holding kind) { return kind != Holding::viscous; }

template <int Dim>
KRATER_FORCE_INLINE void load_hourglass(const ElementData& d, int g,
                                        Pack (&Q)[hourglass_size(Dim)]) {
  constexpr int size = hourglass_size(Dim);
  for (int k = 0; k < size; ++k) Q[k] = load(d.hourglass + (size * g + k) * kLanes);
}

/// Length of the viscosity: of the whole element, that waves along a flat one see it too, but no
/// more than twice the stable one: across a flat element its damping would else demand a step that
/// falls with the square of the thickness.
template <int Dim>
KRATER_FORCE_INLINE Pack viscous_length(Pack measure, Pack stable) {
  const Pack whole = Dim == 3 ? measure * rcbrt(measure) * rcbrt(measure) : sqrt(measure);
  return min(whole, 2.0 * stable);
}

/// Of the dampers f = - c_h/4 rho c S (sum_K G_K v_K) G_I, G = N gamma, S the area of a face.
template <int Dim>
KRATER_FORCE_INLINE Pack damper(const ElementData& d, Pack rho_c, Pack measure, Pack volume) {
  constexpr int N = corner_nodes(Dim);
  const Pack face = Dim == 3 ? measure * rcbrt(measure) : volume / sqrt(measure);
  return 0.25 * d.held.viscous * N * N * rho_c * face;
}

/// By the corners.
template <class Frame, ElementReference On>
struct ByCorners {
  static constexpr int D = Frame::dim, N = corner_nodes(D), size = hourglass_size(D);
  static constexpr bool current = On == ElementReference::current;
  using Values = Pack[N][D];
  struct Motion {
    Values v;
  };
  ElementGeometry<Pack, Frame> e;
  ReferenceElement<Frame> r;
  HourglassFrame<Pack, D> h;
  Pack measure;      ///< of viscosity and dampers
  Pack moved[size];  ///< along the element's directions

  KRATER_FORCE_INLINE void place(const ElementData& d, int g, const Values& x) {
    if constexpr (current) {
      find_geometry(x, e);
    } else {
      const double* from = d.placed + kPlaced<D> * kLanes * g;
      for (int I = 0; I < N; ++I)
        for (int a = 0; a < D; ++a) r.X[I][a] = load(from + (D * I + a) * kLanes);
      find_geometry(r.X, r.start);
      scale_geometry(load(from + D * N * kLanes), r.start);
      carry(x, r, e);
    }
    measure = plane_measure(x, e.volume);
  }
  /// The same element at other corners.
  KRATER_FORCE_INLINE void place_again(const Values& x) {
    if constexpr (current)
      find_geometry(x, e);
    else
      carry(x, r, e);
    measure = plane_measure(x, e.volume);
  }
  /// New references of elements that are strained too far on theirs; which they are.
  template <Holding Kind>
  KRATER_FORCE_INLINE Mask renew(const ElementData& d, int g, const Values& x) const {
    ElementGeometry<Pack, Frame> now;
    find_geometry(x, now);
    const Mask far = renewable(r, e, now, d.refresh_strain);
    if (bits(far) == 0) return far;
    if constexpr (keeps(Kind)) {
      Pack Q[size], held[size];
      load_hourglass<D>(d, g, Q);
      load_hourglass<D>(d, g, held);
      carry_stress(r, now, e.volume, x, held);
      for (int k = 0; k < size; ++k)
        store(d.hourglass + (size * g + k) * kLanes, select(far, held[k], Q[k]));
    }
    double* to = d.placed + kPlaced<D> * kLanes * g;
    for (int I = 0; I < N; ++I)
      for (int a = 0; a < D; ++a) store(to + (D * I + a) * kLanes, select(far, x[I][a], r.X[I][a]));
    double* share = to + D * N * kLanes;
    store(share, select(far, e.volume / now.volume, load(share)));
    return far;
  }
  template <Holding Kind>
  KRATER_FORCE_INLINE void keep(const Corners<D>& at, double* kept) const {
    for (int I = 0; I < N; ++I)
      for (int i = 0; i < D; ++i) {
        store(kept + (D * I + i) * kLanes, at.x[I][i]);
        store(kept + (D * (N + I) + i) * kLanes, at.v[I][i]);
      }
  }
  template <Holding Kind>
  KRATER_FORCE_INLINE void take(const ElementData& d, int g, const double* kept, Corners<D>& at) {
    for (int I = 0; I < N; ++I)
      for (int i = 0; i < D; ++i) {
        at.x[I][i] = load(kept + (D * I + i) * kLanes);
        at.v[I][i] = load(kept + (D * (N + I) + i) * kLanes);
      }
    place(d, g, at.x);
  }
  KRATER_FORCE_INLINE Pack volume() const { return e.volume; }
  KRATER_FORCE_INLINE Pack reference_volume() const { return current ? e.volume : r.start.volume; }
  KRATER_FORCE_INLINE Pack squares() const { return squares_of(current ? e : r.start); }

  static KRATER_FORCE_INLINE void find_motion(const Values& v, Motion& out) {
    for (int I = 0; I < N; ++I)
      for (int i = 0; i < D; ++i) out.v[I][i] = v[I][i];
  }
  static KRATER_FORCE_INLINE void add(double share, const Motion& dv, const Motion& to,
                                      Motion& out) {
    for (int I = 0; I < N; ++I)
      for (int i = 0; i < D; ++i) out.v[I][i] = fma(Pack(share), dv.v[I][i], to.v[I][i]);
  }
  KRATER_FORCE_INLINE Mat3<Pack> gradient(const Motion& m, Pack scale) const {
    return mean_gradient(e, m.v, scale);
  }
  KRATER_FORCE_INLINE Pack stable(const Pack (&share)[N], Pack rho) const {
    return stable_length(e, share, rho);
  }

  template <Holding Kind>
  KRATER_FORCE_INLINE void add_hourglass(const ElementData& d, int g, const Corners<D>& at,
                                         Pack rho_c, Values& f) {
    if constexpr (keeps(Kind)) {
      Pack Q[size];
      load_hourglass<D>(d, g, Q);
      if constexpr (current) {
        find_hourglass(e, at.x, h);
        add_hourglass_force<Pack, D>(h, Q, f);
      } else {
        find_hourglass(r.start, r.X, h);
        add_pulled_force(h, r, at.x, Q, f);
      }
    } else {
      ElementGeometry<Pack, Frame> now = e;
      if constexpr (!current) find_geometry(at.x, now);  // dampers know no start
      find_hourglass(now, at.x, h);
      const Pack strength =
          damper<D>(d, rho_c, current ? measure : plane_measure(at.x, e.volume), e.volume);
      for (int a = 0; a < hourglass_modes(D); ++a)
        for (int i = 0; i < D; ++i) {
          Pack sum = 0.0;
          for (int I = 0; I < N; ++I) sum = fma(h.gamma[a][I], at.v[I][i] - at.v[0][i], sum);
          for (int I = 0; I < N; ++I) f[I][i] = fnma(strength * sum, h.gamma[a][I], f[I][i]);
        }
    }
  }
  template <Holding Kind>
  KRATER_FORCE_INLINE void forces(const ElementData& d, int g, const Corners<D>& at,
                                  const Sym3<Pack>& sigma, Pack rho_c, Values& f) {
    for (auto& corner : f)
      for (Pack& component : corner) component = 0.0;
    add_stress_force(e, sigma, f);
    add_hourglass<Kind>(d, g, at, rho_c, f);
  }
  template <Holding Kind>
  KRATER_FORCE_INLINE Pack power(const ElementData& d, int g, const Corners<D>& at, const Motion&,
                                 const Motion& middle, const Mat3<Pack>&, Pack rho_c) {
    Values f;
    for (auto& corner : f)
      for (Pack& component : corner) component = 0.0;
    add_hourglass<Kind>(d, g, at, rho_c, f);  // of the v- that it was found with
    Pack held = 0.0;
    for (int I = 0; I < N; ++I)
      for (int i = 0; i < D; ++i) held = fnma(f[I][i], middle.v[I][i] - middle.v[0][i], held);
    return held;
  }
  KRATER_FORCE_INLINE void begin_modes(const Corners<D>& at, const Motion& m, const Mat3<Pack>&,
                                       double dt) {
    if constexpr (current) {
      hourglass_rates<Pack, D>(h, m.v, moved);
      for (Pack& q : moved) q = dt * q;
    } else {
      Pack modes[hourglass_modes(D)][D];
      pulled_modes(h, r, at.x, modes, moved);
    }
  }
  KRATER_FORCE_INLINE void end_modes(const Corners<D>& at) {
    if constexpr (!current) {
      Pack modes[hourglass_modes(D)][D], after[size];
      pulled_modes(h, r, at.x, modes, after);
      for (int k = 0; k < size; ++k) moved[k] = after[k] - moved[k];
    }
  }
  KRATER_FORCE_INLINE const Pack (&per_length() const)[D] { return h.per_a; }
};

/// By the modes: q and F along the grid's axes, Q along the element's.
struct ByModes {
  static constexpr int D = 3, N = 8, size = 12;
  static constexpr bool current = true;
  using Values = Pack[8][3];
  struct Motion {
    CornerModes<Pack> u;
  };
  Hexahedron<Pack> e;
  Pack directions[3][3], per_a[3], F[4][3], moved[12];

  KRATER_FORCE_INLINE void place(const ElementData&, int, const Values& x) { place_again(x); }
  KRATER_FORCE_INLINE void place_again(const Values& x) {
    find_modes(x, e.a);
    e.find_slopes();
  }
  template <Holding Kind>
  KRATER_FORCE_INLINE void keep(const Corners<3>& at, double* kept) const {
    double* to = kept;
    const auto put = [&to](Pack value) {
      store(to, value);
      to += kLanes;
    };
#pragma GCC unroll 7
    for (int m = 1; m < 8; ++m)
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) {
        put(e.a[m][i]);
        if (m < 7) put(e.c[m][i]);
      }
    put(e.volume);
    if constexpr (!keeps(Kind))
      for (int I = 0; I < 8; ++I)
        for (int i = 0; i < 3; ++i) put(at.v[I][i]);
  }
  template <Holding Kind>
  KRATER_FORCE_INLINE void take(const ElementData&, int, const double* kept, Corners<3>& at) {
    const double* from = kept;
    const auto get = [&from] {
      const Pack value = load(from);
      from += kLanes;
      return value;
    };
#pragma GCC unroll 7
    for (int m = 1; m < 8; ++m)
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) {
        e.a[m][i] = get();
        if (m < 7) e.c[m][i] = get();
      }
    e.volume = get();
    if constexpr (!keeps(Kind))
      for (int I = 0; I < 8; ++I)
        for (int i = 0; i < 3; ++i) at.v[I][i] = get();
  }
  KRATER_FORCE_INLINE Pack volume() const { return e.volume; }
  KRATER_FORCE_INLINE Pack reference_volume() const { return e.volume; }
  KRATER_FORCE_INLINE Pack squares() const { return e.squares(); }

  static KRATER_FORCE_INLINE void find_motion(const Values& v, Motion& out) {
    find_modes(v, out.u);
  }
  static KRATER_FORCE_INLINE void add(double share, const Motion& dv, const Motion& to,
                                      Motion& out) {
#pragma GCC unroll 7
    for (int m = 1; m < 8; ++m)
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) out.u[m][i] = fma(Pack(share), dv.u[m][i], to.u[m][i]);
  }
  KRATER_FORCE_INLINE Mat3<Pack> gradient(const Motion& m, Pack scale) const {
    return e.gradient(m.u, scale);
  }
  KRATER_FORCE_INLINE Pack stable(const Pack (&share)[8], Pack rho) const {
    return e.stable_length(share, rho);
  }

  /// F of the stress that is kept.
  KRATER_FORCE_INLINE void find_kept(const ElementData& d, int g) {
    Pack Q[12];
    load_hourglass<3>(d, g, Q);
    e.directions(directions, per_a);
#pragma GCC unroll 4
    for (int m = 0; m < 4; ++m)
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i)
        F[m][i] = fma(directions[0][i], Q[m],
                      fma(directions[1][i], Q[4 + m], directions[2][i] * Q[8 + m]));
  }
  /// F of dampers that feel u.
  KRATER_FORCE_INLINE void find_dampers(const ElementData& d, const Motion& u, Pack rho_c) {
    const Pack strength = damper<3>(d, rho_c, e.volume, e.volume);
    e.hourglass_of(u.u, e.gradient(u.u, 1.0 / e.volume), Pack(1.0), F);
    for (auto& mode : F)
      for (Pack& component : mode) component = strength * component;
  }
  template <Holding Kind>
  KRATER_FORCE_INLINE void forces(const ElementData& d, int g, const Corners<3>& at,
                                  const Sym3<Pack>& sigma, Pack rho_c, Values& f) {
    if constexpr (keeps(Kind)) {
      find_kept(d, g);
    } else {
      Motion u;
      find_motion(at.v, u);
      find_dampers(d, u, rho_c);
    }
    e.forces(sigma, F, f);
  }
  template <Holding Kind>
  KRATER_FORCE_INLINE Pack power(const ElementData& d, int g, const Corners<3>&,
                                 const Motion& before, const Motion& middle,
                                 const Mat3<Pack>& L_middle, Pack rho_c) {
    if constexpr (keeps(Kind))
      find_kept(d, g);
    else
      find_dampers(d, before, rho_c);
    Pack q[4][3], held = 0.0;
    e.hourglass_of(middle.u, L_middle, Pack(1.0), q);
#pragma GCC unroll 4
    for (int m = 0; m < 4; ++m) held = held + dot3(F[m], q[m]);
    return held;
  }
  KRATER_FORCE_INLINE void begin_modes(const Corners<3>&, const Motion& m, const Mat3<Pack>& dtL,
                                       double dt) {
    Pack q[4][3];
    e.hourglass_of(m.u, dtL, Pack(dt), q);
#pragma GCC unroll 3
    for (int k = 0; k < 3; ++k)
#pragma GCC unroll 4
      for (int a = 0; a < 4; ++a) moved[4 * k + a] = dot3(directions[k], q[a]);
  }
  KRATER_FORCE_INLINE void end_modes(const Corners<3>&) {}
  KRATER_FORCE_INLINE const Pack (&per_length() const)[3] { return per_a; }
};

template <class Frame, ElementReference On>
struct ShapeOf {
  using type = ByCorners<Frame, On>;
};
template <>
struct ShapeOf<Cartesian<3>, ElementReference::current> {
  using type = ByModes;
};

}  // namespace krater::inline KRATER_ISA
