// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// One point of a coupled law by itself, without stages: principal strains prescribed, or lateral
/// stresses held by secants, as a laboratory does. Strains logarithmic; strains, stresses and
/// pressure positive in compression (the law's deviator is positive in tension). Energies are per
/// mass, by the trapezoidal rule of the stages.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "krater/materials/law_list.hpp"

namespace krater::test {

template <class Law>
struct ModelSpecimen {
  using State = decltype(Law{}.initial_state());
  using Triple = std::array<double, 3>;

  Law law;
  double length = 0;  ///< [m]
  double rate = 1;    ///< equivalent, of every step [1/s]; 0: 1e-12
  State state = law.initial_state();
  Triple s{};    ///< deviator [Pa]
  Triple eps{};  ///< strain
  double p = 0, v = 1 / law.rho0, energy = 0, plastic = 0, crush = 0, plastic_work = 0;
  double modulus = 0;
  bool failed = false;
  Triple lateral{};  ///< strain of the last step, where stresses are held

  double stress(int k) const { return p + s[static_cast<std::size_t>(k)]; }
  double q() const { return std::sqrt(1.5 * (s[0] * s[0] + s[1] * s[1] + s[2] * s[2])); }
  double volume_strain() const { return eps[0] + eps[1] + eps[2]; }
  double mu() const { return std::expm1(volume_strain()); }
  double shear_modulus() const {
    if constexpr (requires { law.shear_modulus(state); }) {
      return law.shear_modulus(state);
    } else if constexpr (requires { law.kernel.G; }) {
      return law.kernel.G;
    } else {
      return law.G;
    }
  }

  /// Of a law that degrades the deviator by its first column.
  double integrity() const {
    if constexpr (requires { law.degrades(); })
      return law.degrades() ? 1 - state[0] : 1.0;
    else
      return 1.0;
  }

  void step(const Triple& d) {
    const double mean = (d[0] + d[1] + d[2]) / 3, G = shear_modulus(), undamaged = integrity();
    Triple trial;
    double norm = 0;
    for (unsigned k = 0; k < 3; ++k) {
      trial[k] = s[k] / undamaged + 2 * G * (d[k] - mean);
      norm += (d[k] - mean) * (d[k] - mean);
      eps[k] += d[k];
    }
    const double strain = std::sqrt(norm * 2 / 3), rho = law.rho0 * std::exp(volume_strain());
    CoupledStep<double> step{
        {-trial[0], -trial[1], -trial[2], 0, 0, 0}, 0,     strain, rho, 1 / rho, energy, plastic,
        rate > 0 ? strain / rate : 1e12 * strain,   length};
    step.q = equivalent_stress(step.trial);
    if (step.dt <= 0) step.dt = 1;
    const auto u = law.at(state).update(step);
    const double scale = u.q >= step.q ? 1.0 : u.q / step.q;
    const double v_end = 1 / rho, dv = v_end - v;
    energy -= 0.5 * p * dv;
    for (unsigned k = 0; k < 3; ++k) {
      const double end = trial[k] * scale;
      energy += 0.5 * (v + v_end) * 0.5 * (s[k] + end) * (d[k] - mean);
      s[k] = end;
    }
    const double thermal = u.pressure.thermal;
    p = std::max(u.least, (u.pressure.cold + thermal * energy) / (1 + 0.5 * thermal * dv));
    energy -= 0.5 * p * dv;
    v = v_end, plastic += u.plastic, crush += u.crush;
    plastic_work += u.q * u.plastic * v;
    modulus = u.modulus;
    state = u.state;
    failed = failed || u.failed;
  }
  /// In `steps` equal steps.
  void strain(const Triple& d, int steps) {
    for (int i = 0; i < steps; ++i) step({d[0] / steps, d[1] / steps, d[2] / steps});
  }
  void hydrostatic(double to_mu, int steps) {
    const double d = (std::log1p(to_mu) - volume_strain()) / 3;
    strain({d, d, d}, steps);
  }
  /// To a pressure on the unloading line or elastic, by secants of one step.
  void hydrostatic_to_pressure(double pressure) {
    const double K = law.rho0 * law.c0 * law.c0;
    hold(0, std::fabs(pressure - p) / K + 1e-15, pressure, [](ModelSpecimen& m, double x) {
      m.step({x, x, x});
    });
  }
  /// One step of axial strain with the stresses of both lateral axes held.
  void triaxial(double axial, double held) {
    hold(1, std::fabs(axial), held, [axial](ModelSpecimen& m, double x) { m.step({axial, x, x}); });
  }
  /// One step of equal strains along x and y with the stress along z held.
  void biaxial(double axial, double held) {
    hold(2, std::fabs(axial), held, [axial](ModelSpecimen& m, double x) {
      m.step({axial, axial, x});
    });
  }

 private:
  /// Finds x so that the stress of an axis, which grows with x, is `held`: a bracket that widens
  /// from the last solution, then false position (Illinois).
  template <class Take>
  void hold(int axis, double scale, double held, Take take) {
    const ModelSpecimen kept = *this;
    const double start = lateral[static_cast<std::size_t>(axis)];
    const double close = 1e-9 * law.rho0 * law.c0 * law.c0 * 1e-3;
    double answer = start;
    const auto residual = [&](double x) {
      *this = kept;
      take(*this, x);
      answer = x;
      return stress(axis) - held;
    };
    double a = start, ra = residual(a), b = a, rb = ra;
    for (double reach = 1e-3 * scale; ra * rb > 0 && reach < 1; reach *= 2) {
      a = b, ra = rb;
      b = start + (rb > 0 ? -reach : reach);
      rb = residual(b);
    }
    for (int i = 0; i < 200 && std::fabs(rb) > close && std::fabs(b - a) > 1e-16; ++i) {
      const double x = i % 8 == 7 ? 0.5 * (a + b) : b - rb * (b - a) / (rb - ra);
      const double r = residual(x);
      if (r * rb < 0) {
        a = b, ra = rb;
      } else {
        ra *= 0.5;
      }
      b = x, rb = r;
    }
    lateral[static_cast<std::size_t>(axis)] = answer;
  }
};

}  // namespace krater::test
