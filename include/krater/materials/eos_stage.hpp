// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Pressure, internal energy and sound speed of the step: Algorithm 1 (52)-(60) with alpha = beta =
/// 1/2 in specific volume, for every p~ = A + B rho e:
///   e*      = e_n - p^_n dv/2 + work of viscosity and deviator in the step (SpecificWork)
///   p~      = (A + B rho e*) / (1 + w B rho dv/2),   the sign of p~ is that of the numerator
///   p^      = max(w p~, -spall_strength),            w = 0 in tension where the point has failed
///   e_{n+1} = e* - p^ dv/2
/// w is 1 - what damage takes of the pressure (Decision 6, materials/carried_stage.hpp); a sound
/// material without spall strength has p^ = p~. The carried pressure does the work and enters
/// momentum; (55) as printed omits the last term.
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

template <class Real>
struct CarriedEnergyStep {
  EnergyStep<Real> step;  ///< of the carried pressure
  Real effective;         ///< p~
  MaskOf<Real> spalled;
};

/// The same with 1 - w in tension and in compression, and a cut-off (infinite: none).
template <class Real>
KRATER_FORCE_INLINE CarriedEnergyStep<Real> close_carried(const PressureSplit<Real>& split, Real p,
                                                          Real e, Real dv, Real work,
                                                          Real tension_loss, Real compression_loss,
                                                          double spall_strength) {
  const Real half_dv = 0.5 * dv;
  const Real e_star = fnma(p, half_dv, e + work);
  const Real numerator = fma(split.thermal, e_star, split.cold);
  const Real w = Real(1.0) - select(numerator < Real(0.0), tension_loss, compression_loss);
  const Real denominator = fma(w * split.thermal, half_dv, Real(1.0));
  const Real effective = numerator / denominator;
  const Real carried = w * effective;
  const Real pressure = max(Real(-spall_strength), carried);  // this order keeps a NaN
  return {{pressure, fnma(pressure, half_dv, e_star), denominator},
          effective,
          carried < Real(-spall_strength)};
}

/// `carries`: damage or a spall strength stands between p~ and p^.
template <class Law, bool carries>
class EosStage final : public Stage {
 public:
  EosStage(const Law& law, double spall_strength, Layout& layout)
      : law_{law},
        spall_strength_{spall_strength},
        rho_{layout.input<field::Density>(Law::name)},
        p_{layout.state<field::Pressure>(0.0, Law::name)},
        e_{layout.state<field::InternalEnergy>(0.0, Law::name)},
        c_{layout.state<field::SoundSpeed>(law.c0, Law::name)},
        volumes_{layout.local_input<field::SpecificVolumes>(Law::name)},
        work_{layout.local_input<field::SpecificWork>(Law::name)},
        loss_{layout.local_optional<field::CarriedLoss>()} {}

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
      const Pack rho = rho_p(g);
      const Pack v = v_p(g, 1);
      const Pack dv = v - v_p(g, 0);
      const PressureSplit<Pack> split = law_.split(rho, v);
      EnergyStep<Pack> step;
      Pack effective;
      if constexpr (carries) {
        const auto loss = view(batch, loss_);
        const CarriedEnergyStep<Pack> all = close_carried(split, p_p(g), e_p(g), dv, w_p(g),
                                                          loss(g, 0), loss(g, 1), spall_strength_);
        step = all.step;
        effective = all.effective;
        if (any(all.spalled)) batch.ledger->spalls += count_points(batch, g, all.spalled);
      } else {
        step = close_energy(split, p_p(g), e_p(g), dv, w_p(g));
        effective = step.pressure;
      }
      report(batch, FaultKind::no_convergence, g, !(step.denominator > Pack(0.5)));
      p_p.set(g, step.pressure);
      e_p.set(g, step.energy);
      const Pack c_squared = law_.bulk_modulus(rho, v, effective, step.energy) * v;
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
  double spall_strength_;
  Input<field::Density> rho_;
  State<field::Pressure> p_;
  State<field::InternalEnergy> e_;
  State<field::SoundSpeed> c_;
  LocalInput<field::SpecificVolumes> volumes_;
  LocalInput<field::SpecificWork> work_;
  LocalOptional<field::CarriedLoss> loss_;
};

}  // namespace krater::inline KRATER_ISA
