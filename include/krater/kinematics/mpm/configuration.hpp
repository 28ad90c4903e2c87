// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/configuration.hpp
/// The configuration t_a that the weights live on (theory 3, CCF Theorem 1). With F = dx/dx_a,
/// J = det F and the Truesdell rate, the weak form keeps its content on any reference:
///   f_I = - sum V_a P . grad_a N_I(x_a),  V_a P = V_a J sigma F^-T = V sigma F^-T,
///   L = (sum v_I (x) grad_a N_I) F_n^-1,  F_n+1 = F_n + dt sum v_I (x) grad_a N_I.
/// V = m/rho is the current volume, cell averages included, so that force and strain stay adjoint.
/// The affine velocity is the gradient on the reference: the lever x_I - x_p is taken there too.
/// About the axis F_tT = r/R, so V_a P_tT N/R = V sigma_tt N/r: the hoop terms read the same on any
/// reference. Assumption: points of one body share t_a; a fixed reference knows its body alone.
#include "krater/points/batch.hpp"

namespace krater::inline KRATER_ISA {

/// t_a = t_n: updated-Lagrangian; weights at the current position.
struct CurrentConfiguration {
  static constexpr bool fixed = false;
};
/// t_a stays: weights at the reference position, never a crossed cell.
struct FixedConfiguration {
  static constexpr bool fixed = true;
};

/// F^-1 over grid axes: m[a][i] = dX_a/dx_i.
template <int Dim>
struct InverseMap {
  Pack m[Dim][Dim];
};

template <int Dim>
KRATER_FORCE_INLINE void invert(const Pack (&f)[Dim][Dim], Pack (&out)[Dim][Dim]) {
  if constexpr (Dim == 2) {
    const Pack inverse = 1.0 / (f[0][0] * f[1][1] - f[0][1] * f[1][0]);
    out[0][0] = f[1][1] * inverse;
    out[0][1] = -(f[0][1] * inverse);
    out[1][0] = -(f[1][0] * inverse);
    out[1][1] = f[0][0] * inverse;
  } else {
    const auto minor = [&](int i, int a) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, a1 = (a + 1) % 3, a2 = (a + 2) % 3;
      return f[i1][a1] * f[i2][a2] - f[i1][a2] * f[i2][a1];
    };
    const Pack inverse =
        1.0 / (f[0][0] * minor(0, 0) + f[0][1] * minor(0, 1) + f[0][2] * minor(0, 2));
    for (int i = 0; i < 3; ++i)
      for (int a = 0; a < 3; ++a) out[a][i] = minor(i, a) * inverse;
  }
}

/// `F` row-major over grid axes, F[Dim i + a] = dx_i/dX_a.
template <int Dim>
KRATER_FORCE_INLINE InverseMap<Dim> inverse_map(ReadView F, int g) {
  Pack f[Dim][Dim];
  for (int i = 0; i < Dim; ++i)
    for (int a = 0; a < Dim; ++a) f[i][a] = F(g, Dim * i + a);
  InverseMap<Dim> out;
  invert<Dim>(f, out.m);
  return out;
}

/// Upper bound of 1/(smallest singular value of F)^2: the largest row sum of |F^-1 F^-T|. Exact for
/// a rotation and for stretches along the grid axes.
template <int Dim>
KRATER_FORCE_INLINE Pack inverse_stretch_squared(const InverseMap<Dim>& inverse) {
  Pack largest = 0.0;
  for (int a = 0; a < Dim; ++a) {
    Pack row = 0.0;
    for (int b = 0; b < Dim; ++b) {
      Pack product = 0.0;
      for (int i = 0; i < Dim; ++i) product = fma(inverse.m[a][i], inverse.m[b][i], product);
      row += abs(product);
    }
    largest = max(largest, row);
  }
  return largest;
}

/// Largest component of twice the Green-Lagrange strain, |F^T F - I|: blind to rotations.
template <int Dim>
KRATER_FORCE_INLINE Pack stretch_measure(ReadView F, int g) {
  Pack largest = 0.0;
  for (int a = 0; a < Dim; ++a)
    for (int b = a; b < Dim; ++b) {
      Pack product = a == b ? -1.0 : 0.0;
      for (int i = 0; i < Dim; ++i) product = fma(F(g, Dim * i + a), F(g, Dim * i + b), product);
      largest = max(largest, abs(product));
    }
  return largest;
}

}  // namespace krater::inline KRATER_ISA
