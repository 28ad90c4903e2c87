// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Pressure, internal energy and sound speed of the step: Algorithm 1 (52)-(60) with alpha = beta =
/// 1/2 in specific volume, for an undamaged material (phi = 0), for every p = A + B rho e:
///   e*      = e_n - p_n dv/2 + w,     w = viscous and deviatoric work of the step (SpecificWork)
///   p       = (A + B rho e*) / (1 + B rho dv/2)
///   e_{n+1} = e* - p dv/2
/// Where p is not linear in e (tillotson), A and B rho are the tangent at e_{n+1}, found by Newton.
/// The carried pressure does the work and enters momentum; (55) as printed omits the last term.
/// A strength law may keep voids out of the equation of state, v - void_volume, and limit the
/// tension that is carried (strength/drucker_prager.hpp); the clipped pressure does the work.
/// c^2 = K_s/rho, floored at 0.01 c0^2 and counted (theory 9).
#pragma once

#include "krater/materials/batch_access.hpp"
#include "krater/materials/eos/split.hpp"
#include "krater/materials/law.hpp"

namespace krater::inline KRATER_ISA {

template <class Real>
struct EnergyStep {
  Real pressure;
  Real energy;
  Real denominator;  ///< must exceed 1/2, or the step was far too long
};

template <class Real>
KRATER_FORCE_INLINE EnergyStep<Real> close_energy(const PressureSplit<Real>& split, Real p, Real e,
                                                  Real dv, Real work) {
  const Real half_dv = 0.5 * dv;
  const Real e_star = fnma(p, half_dv, e + work);
  const Real denominator = fma(split.thermal, half_dv, Real(1.0));
  const Real pressure = fma(split.thermal, e_star, split.cold) / denominator;
  return {pressure, fnma(pressure, half_dv, e_star), denominator};
}

/// The same for any law: Newton over the tangent, which is Algorithm 1 itself with the tangent at
/// the last iterate. Where it does not converge the denominator is zero.
template <class Law, class Real>
KRATER_FORCE_INLINE EnergyStep<Real> advance_energy(const Law& law, Real rho, Real v, Real p,
                                                    Real e, Real dv, Real work) {
  if constexpr (LinearInEnergy<Law>) {
    return close_energy(law.split(rho, v), p, e, dv, work);
  } else {
    constexpr int cap = 50;  // 2 or 3 off the borders of the law's regimes
    const Real scale = Real(1e-12 * law.c0 * law.c0);
    EnergyStep<Real> step{p, e, Real(1.0)};
    Real last = e;
    MaskOf<Real> active = Real(0.0) == Real(0.0);
    for (int i = 0; i < cap && any(active); ++i) {
      const EnergyStep<Real> next = close_energy(law.tangent(rho, v, last), p, e, dv, work);
      step = {select(active, next.pressure, step.pressure),
              select(active, next.energy, step.energy),
              select(active, next.denominator, step.denominator)};
      active = active & !(abs(next.energy - last) <= fma(Real(1e-12), abs(next.energy), scale));
      last = step.energy;
    }
    return {step.pressure, step.energy, select(active, Real(0.0), step.denominator)};
  }
}

/// The same step with a pressure not below `least`, which then does the work.
template <class Real>
KRATER_FORCE_INLINE EnergyStep<Real> limited(const EnergyStep<Real>& step, Real least, Real dv) {
  const Real pressure = max(least, step.pressure);  // this order keeps a NaN
  return {pressure, fma(step.pressure - pressure, 0.5 * dv, step.energy), step.denominator};
}

template <class Law>
class EosStage final : public Stage {
 public:
  EosStage(const Law& law, Layout& layout)
      : law_{law},
        rho_{layout.input<field::Density>(Law::name)},
        p_{layout.state<field::Pressure>(pressure_at_start(law), Law::name)},
        e_{layout.state<field::InternalEnergy>(energy_at_start(law), Law::name)},
        c_{layout.state<field::SoundSpeed>(law.c0, Law::name)},
        volumes_{layout.local_input<field::SpecificVolumes>(Law::name)},
        work_{layout.local_input<field::SpecificWork>(Law::name)},
        voids_{layout.optional<field::VoidVolume>()},
        tension_limit_{layout.local_optional<field::TensionLimit>()} {}

  StageOrder order() const override { return StageOrder::equation_of_state; }

  void apply(const BatchData& batch) const override {
    const auto rho_p = view(batch, rho_);
    const auto p_p = view(batch, p_);
    const auto e_p = view(batch, e_);
    const auto c_p = view(batch, c_);
    const auto v_p = view(batch, volumes_);
    const auto w_p = view(batch, work_);
    const Pack floor = Pack(0.01 * law_.c0 * law_.c0);
    for (int g = 0; g < batch.groups; ++g) {
      Pack rho = rho_p(g);
      Pack v = v_p(g, 1);
      const Pack per_rho = v;
      const Pack dv = v - v_p(g, 0);
      if (voids_.offset >= 0) {
        v = v - view(batch, voids_)(g);
        rho = 1.0 / v;
      }
      EnergyStep<Pack> step = advance_energy(law_, rho, v, p_p(g), e_p(g), dv, w_p(g));
      if (tension_limit_.offset >= 0) step = limited(step, view(batch, tension_limit_)(g), dv);
      report(batch, FaultKind::no_convergence, g, !(step.denominator > Pack(0.5)));
      p_p.set(g, step.pressure);
      e_p.set(g, step.energy);
      const Pack c_squared = law_.bulk_modulus(rho, v, step.pressure, step.energy) * per_rho;
      c_p.set(g, sqrt(max(floor, c_squared)));  // this order keeps a NaN
      const Mask floored = c_squared < floor;
      if (any(floored)) batch.ledger->sound_speed_floors += count_points(batch, g, floored);
      if constexpr (requires { law_.beyond_pole(rho); }) {
        const Mask beyond = law_.beyond_pole(rho);
        if (any(beyond)) batch.ledger->hugoniot_poles += count_points(batch, g, beyond);
      }
    }
  }

 private:
  Law law_;
  Input<field::Density> rho_;
  State<field::Pressure> p_;
  State<field::InternalEnergy> e_;
  State<field::SoundSpeed> c_;
  LocalInput<field::SpecificVolumes> volumes_;
  LocalInput<field::SpecificWork> work_;
  Optional<field::VoidVolume> voids_;
  LocalOptional<field::TensionLimit> tension_limit_;
};

}  // namespace krater::inline KRATER_ISA
