// SPDX-License-Identifier: GPL-3.0-or-later
/// \file kinematics/sph/sph_lanes.hpp
/// Tensors over grid axes, columns and records of particles, eight at a time.
#pragma once

#include "krater/core/simd_rows.hpp"
#include "krater/kinematics/sph/correction.hpp"
#include "krater/kinematics/sph/sph_kernels.hpp"
#include "krater/materials/batch_access.hpp"

namespace krater::inline KRATER_ISA {

/// Row or column of a tensor that a grid axis is: plane strain has y across.
template <int Dim>
constexpr int axis_of_tensor(int grid_axis) {
  return Dim == 2 && grid_axis == 1 ? 2 : grid_axis;
}

/// A tensor over grid axes.
template <int Dim>
struct Axes {
  Pack c[Dim][Dim];
};

template <int Dim>
KRATER_FORCE_INLINE Axes<Dim> zero_axes() {
  Axes<Dim> out;
  for (auto& row : out.c)
    for (Pack& entry : row) entry = 0.0;
  return out;
}

template <int Dim>
KRATER_FORCE_INLINE Mat3<Pack> in_space(const Axes<Dim>& a, Pack across) {
  Pack m[3][3] = {{Pack(0.0), Pack(0.0), Pack(0.0)},
                  {Pack(0.0), across, Pack(0.0)},
                  {Pack(0.0), Pack(0.0), Pack(0.0)}};
  for (int i = 0; i < Dim; ++i)
    for (int k = 0; k < Dim; ++k) m[axis_of_tensor<Dim>(i)][axis_of_tensor<Dim>(k)] = a.c[i][k];
  return {m[0][0], m[0][1], m[0][2], m[1][0], m[1][1], m[1][2], m[2][0], m[2][1], m[2][2]};
}
template <int Dim>
KRATER_FORCE_INLINE Axes<Dim> along_grid(const Mat3<Pack>& a) {
  const Pack m[3][3] = {{a.xx, a.xy, a.xz}, {a.yx, a.yy, a.yz}, {a.zx, a.zy, a.zz}};
  Axes<Dim> out;
  for (int i = 0; i < Dim; ++i)
    for (int k = 0; k < Dim; ++k) out.c[i][k] = m[axis_of_tensor<Dim>(i)][axis_of_tensor<Dim>(k)];
  return out;
}
KRATER_FORCE_INLINE Mat3<Pack> as_matrix(const Sym3<Pack>& s) {
  return {s.xx, s.xy, s.xz, s.xy, s.yy, s.yz, s.xz, s.yz, s.zz};
}

/// a K.
template <int Dim>
KRATER_FORCE_INLINE Axes<Dim> times(const Axes<Dim>& a, const SymAxes<Pack, Dim>& K) {
  Axes<Dim> out = zero_axes<Dim>();
  for (int i = 0; i < Dim; ++i)
    for (int k = 0; k < Dim; ++k)
      for (int n = 0; n < Dim; ++n) out.c[i][k] = fma(a.c[i][n], K.at(n, k), out.c[i][k]);
  return out;
}

/// Columns that the sweeps read and write.
struct SphViews {
  WriteView position, velocity, energy;
  ReadView mass, density, stress, pressure, viscous, sound_speed;
};
KRATER_FORCE_INLINE SphViews views_of(const SphData& d, const double* zeros) {
  const SphColumns& c = d.columns;
  const auto read = [&](int offset) {
    return offset < 0 ? ReadView{zeros, 0} : ReadView{d.particles + offset, c.stride};
  };
  const auto write = [&](int offset) { return WriteView{d.particles + offset, c.stride}; };
  return {write(c.position), write(c.velocity), write(c.energy),
          read(c.mass),      read(c.density),   read(c.stress),
          read(c.pressure),  read(c.viscous),   read(c.sound_speed)};
}

KRATER_FORCE_INLINE Sym3<Pack> whole_stress(const SphViews& v, int g) {
  Sym3<Pack> s = load_sym3(v.stress, g);
  const Pack p = v.pressure(g) + v.viscous(g);
  s.xx = s.xx - p;
  s.yy = s.yy - p;
  s.zz = s.zz - p;
  return s;
}

template <int Dim>
KRATER_FORCE_INLINE SymAxes<Pack, Dim> load_correction(const SphData& d, int g) {
  SymAxes<Pack, Dim> K;
  for (int k = 0; k < K.size; ++k) K.c[k] = load(d.correction + (6 * g + k) * kLanes);
  return K;
}

KRATER_FORCE_INLINE Mat3<Pack> load_deformation(const SphData& d, int g) {
  return load_mat3(ReadView{d.deformation, 9 * kLanes}, g);
}

/// Records that begin at `from`, eight of them, by components.
KRATER_FORCE_INLINE void gather_records(const double* from, int stride, const std::int32_t* lanes,
                                        Pack (&r)[8]) {
  load_rows([=](int l) { return from + stride * lanes[l]; }, r);
}
KRATER_FORCE_INLINE void store_records(double* to, int stride, Pack (&r)[8]) {
  transpose8(r);
  for (int l = 0; l < kLanes; ++l) store(to + stride * l, r[l]);
}

/// Records of load by components.
template <int Lines>
struct Loads {
  Pack r[Lines][8];
  KRATER_FORCE_INLINE Pack operator[](int place) const { return r[place / 8][place % 8]; }
};
inline constexpr std::int32_t kOwnLanes[kLanes] = {0, 1, 2, 3, 4, 5, 6, 7};
template <int Lines>
KRATER_FORCE_INLINE void gather_loads(const double* from, int stride, const std::int32_t* lanes,
                                      Loads<Lines>& out) {
  for (int line = 0; line < Lines; ++line)
    gather_records(from + 8 * line, stride, lanes, out.r[line]);
}

/// What the step changes a group's velocities by, and heat.
KRATER_FORCE_INLINE void load_changes(const SphData& d, int g, Pack (&out)[4]) {
  load_columns([&](int l) { return d.changes + 4 * (kLanes * g + l); }, 0, out);
}

/// A group's own records of motion.
template <int Dim>
struct Own {
  Pack x[Dim], v[Dim], volume;
};
template <int Dim>
KRATER_FORCE_INLINE Own<Dim> load_own(const SphData& d, int g) {
  Pack r[8];
  load_rows([&](int l) { return d.motion + kMotion * (kLanes * g + l); }, r);
  Own<Dim> out;
  for (int a = 0; a < Dim; ++a) {
    out.x[a] = r[a];
    out.v[a] = r[4 + a];
  }
  out.volume = r[3];
  return out;
}

}  // namespace krater::inline KRATER_ISA
