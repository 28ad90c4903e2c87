// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The isentrope of an equation of state through its reference state (rho0, T_ref, energy at the
/// start), u = ln(rho/rho0) (theory 8):
///   de_s/du = p(rho, e_s)/rho,   d ln T_s/du = Gamma = (dp/de)/rho;
/// for Gamma rho constant that is T_s = T_ref exp(Gamma0 eta), for Gamma constant T_ref x^Gamma0.
/// Integrated once (Runge-Kutta of fourth order) into a table of cubics with the exact slopes at
/// the nodes, one of which is rho0, where most equations of state change branch. Measured against
/// quadrature (unit/materials/internal_energy): T_s to 1e-7 of itself, e_s to 2e-7 c0^2 (0.01 K)
/// or, next to a pole, 1e-6 of itself. Beyond the table, x = 1e-3 and 12, its ends are held.
#pragma once

#include "krater/core/lane_math.hpp"
#include "krater/materials/eos/split.hpp"

namespace krater::inline KRATER_ISA {

class Isentrope {
 public:
  template <class Real>
  struct State {
    Real temperature;  ///< T_s [K]
    Real energy;       ///< e_s [J/kg]
  };

  template <class Law>
  void tabulate(const Law& law, double T_ref) {
    const Node start = node_at(law, 0.0, {energy_at_start(law), 0.0}, T_ref);
    Node node = start;
    for (int i = kBelow; i < kRows; ++i) {
      const Node next = advance(law, node, kStep, T_ref);
      fill(rows_[i], node, next);
      node = next;
    }
    node = start;
    for (int i = kBelow - 1; i >= 0; --i) {
      const Node next = advance(law, node, -kStep, T_ref);
      fill(rows_[i], next, node);
      node = next;
    }
  }

  /// At rho/rho0 = 1 + mu.
  template <class Real>
  KRATER_FORCE_INLINE State<Real> at(Real mu) const {
    const Real place =
        clamp(fma(log(mu + 1.0), Real(kPerUnit), Real(kBelow)), Real(0.0), Real(kRows));
    const Real row = clamp(lane_math_detail::nearest(place - 0.5), Real(0.0), Real(kRows - 1));
    const Real t = place - row;
    Real c[8];
    fetch(select(row == row, row, Real(0.0)), c);  // a NaN is no index; it comes through t
    return {fma(fma(fma(c[7], t, c[6]), t, c[5]), t, c[4]),
            fma(fma(fma(c[3], t, c[2]), t, c[1]), t, c[0])};
  }

 private:
  static constexpr int kPerUnit = 48, kBelow = 7 * kPerUnit, kAbove = 5 * kPerUnit / 2,
                       kRows = kBelow + kAbove;
  static constexpr double kStep = 1.0 / kPerUnit;

  struct Slope {
    double energy, log_T;
  };
  /// A point of the isentrope, with slopes by u.
  struct Node {
    double u;
    Slope y;  ///< e_s and ln(T_s/T_ref) themselves
    double T, energy_slope, T_slope;
  };

  template <class Law>
  static Slope slope(const Law& law, double u, double e) {
    const double rho = law.rho0 * exp(u), v = 1.0 / rho;
    const PressureSplit<double> split = split_at(law, rho, v, e);
    return {fma(split.thermal, e, split.cold) * v, split.thermal * v};
  }

  template <class Law>
  static Node node_at(const Law& law, double u, Slope y, double T_ref) {
    const Slope s = slope(law, u, y.energy);
    const double T = T_ref * exp(y.log_T);
    return {u, y, T, s.energy, s.log_T * T};
  }

  template <class Law>
  static Node advance(const Law& law, const Node& from, double du, double T_ref) {
    constexpr int parts = 16;
    const double h = du / parts;
    Slope y = from.y;
    for (int i = 0; i < parts; ++i) {
      const double u = from.u + i * h;
      const Slope a = slope(law, u, y.energy);
      const Slope b = slope(law, u + 0.5 * h, y.energy + 0.5 * h * a.energy);
      const Slope c = slope(law, u + 0.5 * h, y.energy + 0.5 * h * b.energy);
      const Slope d = slope(law, u + h, y.energy + h * c.energy);
      y.energy += h / 6.0 * (a.energy + 2.0 * (b.energy + c.energy) + d.energy);
      y.log_T += h / 6.0 * (a.log_T + 2.0 * (b.log_T + c.log_T) + d.log_T);
    }
    return node_at(law, from.u + du, y, T_ref);
  }

  /// Cubics over t in [0, 1] from values and slopes at both ends.
  static void fill(double (&row)[8], const Node& a, const Node& b) {
    const auto cubic = [](double* c, double y0, double y1, double s0, double s1) {
      const double m0 = kStep * s0, m1 = kStep * s1;
      c[0] = y0;
      c[1] = m0;
      c[2] = 3.0 * (y1 - y0) - 2.0 * m0 - m1;
      c[3] = 2.0 * (y0 - y1) + m0 + m1;
    };
    cubic(row, a.y.energy, b.y.energy, a.energy_slope, b.energy_slope);
    cubic(row + 4, a.T, b.T, a.T_slope, b.T_slope);
  }

  KRATER_FORCE_INLINE void fetch(double row, double (&c)[8]) const {
    const double* from = rows_[static_cast<int>(row)];
    for (int k = 0; k < 8; ++k) c[k] = from[k];
  }
  KRATER_FORCE_INLINE void fetch(Pack row, Pack (&c)[8]) const {
    alignas(64) double at[8], columns[8][8];
    store(at, row);
    for (int l = 0; l < 8; ++l) {
      const double* from = rows_[static_cast<int>(at[l])];
      for (int k = 0; k < 8; ++k) columns[k][l] = from[k];
    }
    for (int k = 0; k < 8; ++k) c[k] = load(columns[k]);
  }

  double rows_[kRows][8];
};

}  // namespace krater::inline KRATER_ISA
