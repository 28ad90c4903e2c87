// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Last stage: the speed of a signal for the time step (theory 12),
///   c_L^2 = c^2 + 4G/(3 rho),  Qv = q_lin c + 2 q_quad l |tr D| where tr D < 0, else 0,
///   signal speed = max(sqrt(c_L^2 + c^2), Qv + sqrt(Qv^2 + c_L^2)),
/// the first for the free edges of a body (`tools/stability.py`),
/// and the one check that the new state is finite. Without viscosity q_lin = q_quad = 0.
///
/// A failed point that is open (p <= 0, s = 0) has no shear to bear: it gets some when it has
/// closed, at the density rho0 or above, so that its G meets 1/rho0 and not 1/rho, which in a spray
/// of rubble is a hundred times as much and would shorten every step.
#pragma once

#include "krater/materials/batch_access.hpp"
#include "krater/materials/stage.hpp"

namespace krater::inline KRATER_ISA {

template <class Real>
KRATER_FORCE_INLINE Real signal_speed(Real c, Real G, Real v, Real tr_D, double q_lin,
                                      double q_quad, Real length) {
  const Real closing = max(Real(0.0), -tr_D);
  const Real viscous = fma((2.0 * q_quad) * length, closing, q_lin * c);
  const Real Qv = select(tr_D < Real(0.0), viscous, Real(0.0));
  const Real c_L_squared = fma(c, c, (4.0 / 3.0) * G * v);
  return max(sqrt(fma(c, c, c_L_squared)), Qv + sqrt(fma(Qv, Qv, c_L_squared)));
}

template <bool fails>
class SignalSpeedStage final : public Stage {
 public:
  SignalSpeedStage(double q_lin, double q_quad, double density, Layout& layout)
      : q_lin_{q_lin},
        q_quad_{q_quad},
        closed_{1.0 / density},
        volumes_{layout.local_input<field::SpecificVolumes>("signal_speed")},
        c_{layout.input<field::SoundSpeed>("signal_speed")},
        p_{layout.optional<field::Pressure>()},
        e_{layout.optional<field::InternalEnergy>()},
        s_{layout.optional<field::DeviatoricStress>()},
        failed_{layout.optional<field::Failed>()},
        shear_{layout.local_optional<field::ShearModulus>()},
        rate_{layout.local_input<field::DilatationRate>("signal_speed")},
        signal_{layout.local_output<field::SignalSpeed>("signal_speed")} {}

  void apply(const BatchData& batch) const override {
    const auto v_p = view(batch, volumes_);
    const auto c_p = view(batch, c_);
    const auto p_p = view(batch, p_);
    const auto e_p = view(batch, e_);
    const auto s_p = view(batch, s_);
    const auto G_p = view(batch, shear_);
    const auto trD_p = view(batch, rate_);
    const auto signal_p = view(batch, signal_);
    const ReadView length = lengths(batch);
    for (int g = 0; g < batch.groups; ++g) {
      const Sym3<Pack> s = load_sym3(s_p, g);
      const Pack c = c_p(g);
      const Pack state =
          ((p_p(g) + e_p(g)) + c) + (((s.xx + s.yy) + s.zz) + ((s.yz + s.xz) + s.xy));
      Pack v = v_p(g, 1);
      if constexpr (fails) {
        const Mask open = (view(batch, failed_)(g) > Pack(0.5)) & !(p_p(g) > Pack(0.0)) &
                          !(contract(s, s) > Pack(0.0));
        v = select(open, min(v, Pack(closed_)), v);
      }
      const Pack signal = signal_speed(c, G_p(g), v, trD_p(g), q_lin_, q_quad_, length(g));
      signal_p.set(g, signal);
      report(batch, FaultKind::not_finite_state, g, !is_finite(state + signal));
    }
  }

 private:
  double q_lin_, q_quad_, closed_;
  LocalInput<field::SpecificVolumes> volumes_;
  Input<field::SoundSpeed> c_;
  Optional<field::Pressure> p_;
  Optional<field::InternalEnergy> e_;
  Optional<field::DeviatoricStress> s_;
  Optional<field::Failed> failed_;
  LocalOptional<field::ShearModulus> shear_;
  LocalInput<field::DilatationRate> rate_;
  LocalOutput<field::SignalSpeed> signal_;
};

}  // namespace krater::inline KRATER_ISA
