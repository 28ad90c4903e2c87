// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Pressure, internal energy and sound speed of the step: Algorithm 1, CCF (52)-(60), in specific
/// volume, for every p~ = A + B rho e (theory 9), alpha + beta = 1, both 1/2 unless asked for:
///   e*      = e_n - alpha p^_n dv + work of viscosity and deviator in the step (SpecificWork)
///   p~      = (A + B rho e*) / (1 + beta w B rho dv),   the sign of p~ is that of the numerator
///   p^      = max(w p~, -spall_strength),            w = 0 in tension where the point has failed
///   e_{n+1} = e* - beta p^ dv
/// w is 1 - what damage takes of the pressure (Decision 6, stages/carried_stage.hpp); a sound
/// material without spall strength has p^ = p~. The carried pressure does the work and enters
/// momentum; CCF (55) as printed omits the last term.
/// Spall, `action: fail`: where w p~ < -spall_strength the point fails. Its tension is gone before
/// e is formed, so what the tension had stored stays in e as heat; the deviator follows in the next
/// step. From then on the point bears compression only. `action: limit`: the line above, and
/// nothing parts.
/// Where p is not linear in e (tillotson, p_alpha), A and B rho are the tangent at e_{n+1}, found
/// by Newton; a law with history (materials/law_state.hpp) is taken at its state of the start.
/// A strength law may keep voids out of the equation of state, v - void_volume, and limit the
/// tension that is carried (strength/drucker_prager.hpp); the clipped pressure does the work.
/// c^2 = K_s/rho, floored at 0.01 c0^2 and counted.
/// Where a ledger books the work (BatchData::energy_share 0) e is that of t_{n+1/2}; the pressure
/// is beta of a step ahead of it, e* = e + beta of the work of viscosity and deviator, and e stays.
#pragma once

#include <type_traits>

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

/// alpha dv and beta dv; of a number alone half of it each.
template <class Real>
struct VolumeChange {
  Real old_stress, new_stress;
  KRATER_FORCE_INLINE VolumeChange(Real dv) : old_stress{0.5 * dv}, new_stress{old_stress} {}
  KRATER_FORCE_INLINE VolumeChange(Real dv, double alpha)
      : old_stress{alpha * dv}, new_stress{(1.0 - alpha) * dv} {}
};
template <class Real>
using VolumeChangeOf = std::type_identity_t<VolumeChange<Real>>;  ///< lets a number stand for it

template <class Real>
KRATER_FORCE_INLINE EnergyStep<Real> close_energy(const PressureSplit<Real>& split, Real p, Real e,
                                                  const VolumeChangeOf<Real>& dv, Real work) {
  const Real e_star = fnma(p, dv.old_stress, e + work);
  const Real denominator = fma(split.thermal, dv.new_stress, Real(1.0));
  const Real pressure = fma(split.thermal, e_star, split.cold) / denominator;
  return {pressure, fnma(pressure, dv.new_stress, e_star), denominator};
}

/// A and B rho of the step. For a law that is not linear in e: its tangent at e_{n+1}, by Newton,
/// which is Algorithm 1 repeated with the tangent at the last iterate. `close` gives the energy
/// that follows from a split; `found` says where it converged.
template <class Law, class Real, class Close>
KRATER_FORCE_INLINE PressureSplit<Real> split_of_step(const Law& law, Real rho, Real v, Real e,
                                                      const Close& close, MaskOf<Real>& found) {
  found = Real(0.0) == Real(0.0);
  if constexpr (LinearInEnergy<Law>) {
    return law.split(rho, v);
  } else {
    constexpr int cap = 50;  // 2 or 3 off the borders of the law's regimes
    const Real scale = Real(1e-12 * law.c0 * law.c0);
    PressureSplit<Real> split = law.tangent(rho, v, e);
    Real last = e;
    MaskOf<Real> active = found;
    for (int i = 0; i < cap && any(active); ++i) {
      const PressureSplit<Real> next = law.tangent(rho, v, last);
      split = {select(active, next.cold, split.cold), select(active, next.thermal, split.thermal)};
      const Real energy = select(active, close(split), last);
      active = active & !(abs(energy - last) <= fma(Real(1e-12), abs(energy), scale));
      last = energy;
    }
    found = !active;
    return split;
  }
}

/// The step of sound material for any law. Where Newton does not converge the denominator is zero.
template <class Law, class Real>
KRATER_FORCE_INLINE EnergyStep<Real> advance_energy(const Law& law, Real rho, Real v, Real p,
                                                    Real e, const VolumeChangeOf<Real>& dv,
                                                    Real work) {
  MaskOf<Real> found;
  const auto close = [&](const PressureSplit<Real>& s) {
    return close_energy(s, p, e, dv, work).energy;
  };
  EnergyStep<Real> step = close_energy(split_of_step(law, rho, v, e, close, found), p, e, dv, work);
  step.denominator = select(found, step.denominator, Real(0.0));
  return step;
}

/// The same step with a pressure not below `least`, which then does the work.
template <class Real>
KRATER_FORCE_INLINE EnergyStep<Real> limited(const EnergyStep<Real>& step, Real least,
                                             const VolumeChangeOf<Real>& dv) {
  const Real pressure = max(least, step.pressure);  // this order keeps a NaN
  return {pressure, fma(step.pressure - pressure, dv.new_stress, step.energy), step.denominator};
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
                                                          Real e, const VolumeChangeOf<Real>& dv,
                                                          Real work, Real tension_loss,
                                                          Real compression_loss,
                                                          double spall_strength) {
  const Real e_star = fnma(p, dv.old_stress, e + work);
  const Real numerator = fma(split.thermal, e_star, split.cold);
  const Real w = Real(1.0) - select(numerator < Real(0.0), tension_loss, compression_loss);
  const Real denominator = fma(w * split.thermal, dv.new_stress, Real(1.0));
  const Real effective = numerator / denominator;
  const Real carried = w * effective;
  const Real pressure = max(Real(-spall_strength), carried);  // this order keeps a NaN
  return {{pressure, fnma(pressure, dv.new_stress, e_star), denominator},
          effective,
          carried < Real(-spall_strength)};
}

/// How much of the step's work of viscosity and deviator is in e*.
KRATER_FORCE_INLINE double work_share(const BatchData& batch) {
  const double beta = 1.0 - batch.energy_alpha;
  return beta + (1.0 - beta) * batch.energy_share;
}

/// `dilates`: the strength law keeps voids out of the equation of state and limits the effective
/// tension.
template <class Law, Tension tension, bool dilates>
class EosStage final : public Stage {
 public:
  EosStage(const Law& law, double spall_strength, Layout& layout)
      : law_{law},
        state_{law, layout},
        spall_strength_{spall_strength},
        rho_{layout.input<field::Density>(Law::name)},
        p_{layout.state<field::Pressure>(pressure_at_start(law), Law::name)},
        e_{layout.state<field::InternalEnergy>(energy_at_start(law), Law::name)},
        c_{layout.state<field::SoundSpeed>(law.c0, Law::name)},
        volumes_{layout.local_input<field::SpecificVolumes>(Law::name)},
        work_{layout.local_input<field::SpecificWork>(Law::name)} {
    if constexpr (carries) loss_ = layout.local_optional<field::CarriedLoss>();
    if constexpr (Barotropic<Law>) mass_ = layout.input<field::Mass>(Law::name);
    if constexpr (parts) failed_ = layout.state<field::Failed>(0.0, Law::name);
    if constexpr (dilates) {
      voids_ = layout.input<field::VoidVolume>(Law::name);
      tension_limit_ = layout.local_input<field::TensionLimit>(Law::name);
    }
  }

  void apply(const BatchData& batch) const override {
    const auto rho_p = view(batch, rho_);
    const auto p_p = view(batch, p_);
    const auto e_p = view(batch, e_);
    const auto c_p = view(batch, c_);
    const auto v_p = view(batch, volumes_);
    const auto w_p = view(batch, work_);
    const Pack floor = Pack(0.01 * law_.c0 * law_.c0);
    const Pack share = batch.energy_share, ahead = work_share(batch);
    for (int g = 0; g < batch.groups; ++g) {
      const auto& law = state_.at(law_, batch, g);
      Pack rho = rho_p(g);
      Pack v = v_p(g, 1);
      const Pack per_rho = v;
      const Pack dv = v - v_p(g, 0);
      const VolumeChange<Pack> change{dv, batch.energy_alpha};
      if constexpr (dilates) {
        v = v - view(batch, voids_)(g);
        rho = 1.0 / v;
      }
      EnergyStep<Pack> step;
      Pack effective;
      if constexpr (carries) {
        const auto all = carried(batch, g, law, {rho, v, change});
        step = all.step;
        effective = all.effective;
      } else {
        step = advance_energy(law, rho, v, share * p_p(g), e_p(g), change, ahead * w_p(g));
        effective = step.pressure;
      }
      if constexpr (dilates) {
        const Pack least = view(batch, tension_limit_)(g);
        Pack carried = least;
        if constexpr (carries) carried = least * (Pack(1.0) - view(batch, loss_)(g, 0));
        step = limited(step, carried, change);
        effective = max(least, effective);
      }
      report(batch, FaultKind::no_convergence, g, !(step.denominator > Pack(0.5)));
      if constexpr (Barotropic<Law>)
        batch.ledger->barotropic_work +=
            sum(view(batch, mass_)(g) * fnma(p_p(g) + step.pressure, 0.5 * dv, Pack(w_p(g))));
      p_p.set(g, step.pressure);
      e_p.set(g, select(share > Pack(0.0), step.energy, e_p(g)));
      if constexpr (OwnsState<Law>) state_.set(batch, g, law.after(rho, v, step.energy));
      const auto& after = state_.at(law_, batch, g);
      const Pack c_squared = after.bulk_modulus(rho, v, effective, step.energy) * per_rho;
      c_p.set(g, sqrt(max(floor, c_squared)));  // this order keeps a NaN
      const Mask floored = c_squared < floor;
      if (any(floored)) batch.ledger->sound_speed_floors += count_points(batch, g, floored);
      if constexpr (requires { after.beyond_pole(rho); }) {
        const Mask beyond = after.beyond_pole(rho);
        if (any(beyond)) batch.ledger->hugoniot_poles += count_points(batch, g, beyond);
      }
    }
  }

 private:
  static constexpr bool carries = tension != Tension::own, parts = tension == Tension::parting;

  /// Density and volume that the law sees, and the step's change of the latter.
  struct Volume {
    Pack rho, v;
    VolumeChange<Pack> dv;
  };

  /// `law`: as it is at the state of the group.
  KRATER_FORCE_INLINE CarriedEnergyStep<Pack> carried(const BatchData& batch, int g,
                                                      const auto& law, const Volume& x) const {
    const auto loss = view(batch, loss_);
    const Pack p = batch.energy_share * view(batch, p_)(g), e = view(batch, e_)(g),
               work = work_share(batch) * view(batch, work_)(g);
    Pack tension_loss = loss(g, 0);
    if constexpr (parts) {
      const Pack failed = view(batch, failed_)(g);
      report(batch, FaultKind::not_finite_state, g, !is_finite(failed));
      tension_loss = select(failed > Pack(0.5), Pack(1.0), tension_loss);
    }
    const auto closed = [&](const PressureSplit<Pack>& s) {
      return close_carried(s, p, e, x.dv, work, tension_loss, loss(g, 1), spall_strength_);
    };
    const auto energy = [&](const PressureSplit<Pack>& s) { return closed(s).step.energy; };
    Mask found;
    CarriedEnergyStep<Pack> all = closed(split_of_step(law, x.rho, x.v, e, energy, found));
    if (any(all.spalled)) batch.ledger->spalls += count_points(batch, g, all.spalled);
    if constexpr (parts) {
      if (any(all.spalled)) {
        part(batch, g, all.spalled);
        tension_loss = select(all.spalled, Pack(1.0), tension_loss);
        all = closed(split_of_step(law, x.rho, x.v, e, energy, found));
      }
    }
    all.step.denominator = select(found, all.step.denominator, Pack(0.0));
    return all;
  }

  void part(const BatchData& batch, int g, Mask spalled) const {
    const auto failed = view(batch, failed_);
    failed.set(g, select(spalled, Pack(1.0), failed(g)));
    batch.ledger->failures += count_points(batch, g, spalled);
  }

  Law law_;
  StateOf<Law> state_;
  double spall_strength_;
  Input<field::Density> rho_;
  State<field::Pressure> p_;
  State<field::InternalEnergy> e_;
  State<field::SoundSpeed> c_;
  LocalInput<field::SpecificVolumes> volumes_;
  LocalInput<field::SpecificWork> work_;
  LocalOptional<field::CarriedLoss> loss_{-1};  // absent: spall of sound material
  Input<field::Mass> mass_{-1};                 // of a barotropic law
  State<field::Failed> failed_{-1};             // where points part
  Input<field::VoidVolume> voids_{-1};
  LocalInput<field::TensionLimit> tension_limit_{-1};
};

}  // namespace krater::inline KRATER_ISA
