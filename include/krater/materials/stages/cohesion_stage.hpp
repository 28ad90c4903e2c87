// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What has parted carries no shear: with an equation of state whose cold tension ends (`cohesion`,
/// eos/split.hpp) the deviator ends with it,
///   s = g(x) s~,   x = rho/rho0 of what the equation of state sees,
/// where s~ is what the strength law updates. Without this a vapour flows against the yield stress
/// of the solid and heats itself out of its motion (two aluminium spheres at 30 km/s: a fifth of
/// the energy).
///
/// s is the column, as with damage; s~ = s/g(x_n) is got back before the strength's stages and
/// s = g(x_{n+1}) s~ formed after them, so g depends on the density alone and no column is needed.
/// A modulus that fades, ds = 2 g G D, would keep the stress; a factor per step would depend on the
/// step. What s loses stays in e as heat. Groups of points that hold (x >= 0.8) are not touched.
#pragma once

#include "krater/materials/batch_access.hpp"
#include "krater/materials/eos/split.hpp"
#include "krater/materials/stage.hpp"
#include "krater/materials/stages/strength_stage.hpp"

namespace krater::inline KRATER_ISA {

/// An equation of state whose solid parts.
template <class Law>
concept Parting = requires {
  requires Law::parts;
};

class CohesionStage : public Stage {
 public:
  CohesionStage(double rho0, Layout& layout)
      : per_rho0_{1.0 / rho0},
        s_{layout.state<field::DeviatoricStress>(0.0, kName)},
        strain_{layout.local_input<field::StrainStep>(kName)},
        volumes_{layout.local_input<field::SpecificVolumes>(kName)},
        work_{layout.local_output<field::SpecificWork>(kName)},
        voids_{layout.optional<field::VoidVolume>()} {}

 protected:
  static constexpr const char* kName = "cohesion";
  static constexpr double kLeast = 1e-12;  ///< g below which nothing is left

  /// g of the start (0) or the end (1) of the step.
  KRATER_FORCE_INLINE Pack share(const BatchData& batch, int g, int when) const {
    Pack v = view(batch, volumes_)(g, when);
    if (voids_.offset >= 0) v = v - view(batch, voids_)(g);
    return cohesion(Pack(per_rho0_) / v).share;
  }

  /// The deviator times `factor`; the work of the step keeps the carried stress: what the update
  /// added for s~ is made good by W(s - s~), `sign` -1 where s~ is formed and 1 where s is.
  KRATER_FORCE_INLINE void scale(const BatchData& batch, int g, Pack factor, double sign) const {
    const auto s_p = view(batch, s_);
    const auto v = view(batch, volumes_);
    const auto work = view(batch, work_);
    const Sym3<Pack> s = load_sym3(s_p, g);
    const Sym3<Pack> carried_less_effective = (sign * (factor - 1.0)) * s;
    work.set(g, work(g) + deviatoric_work(zero_sym3<Pack>(), carried_less_effective,
                                          load_sym3(view(batch, strain_), g), v(g, 0), v(g, 1)));
    store_sym3(s_p, g, factor * s);
  }

  double per_rho0_;
  State<field::DeviatoricStress> s_;
  LocalInput<field::StrainStep> strain_;
  LocalInput<field::SpecificVolumes> volumes_;
  LocalOutput<field::SpecificWork> work_;
  Optional<field::VoidVolume> voids_;
};

/// s~ = s/g; a material without cohesion has no deviator.
class EffectiveCohesionStage final : public CohesionStage {
 public:
  using CohesionStage::CohesionStage;

  void apply(const BatchData& batch) const override {
    for (int g = 0; g < batch.groups; ++g) {
      const Pack held = share(batch, g, 0);
      if (!any(held < Pack(1.0))) continue;
      scale(batch, g, select(held > Pack(kLeast), 1.0 / held, Pack(0.0)), -1.0);
    }
  }
};

/// s = g s~; shear modulus and plastic work follow.
class CarriedCohesionStage final : public CohesionStage {
 public:
  CarriedCohesionStage(double rho0, Layout& layout)
      : CohesionStage{rho0, layout},
        mass_{layout.input<field::Mass>(kName)},
        shear_{layout.local_output<field::ShearModulus>(kName)},
        plastic_work_{layout.local_optional<field::PlasticWork>()} {}

  void apply(const BatchData& batch) const override {
    const auto shear = view(batch, shear_);
    for (int g = 0; g < batch.groups; ++g) {
      const Pack all = share(batch, g, 1);
      if (!any(all < Pack(1.0))) continue;
      const Pack held = select(all > Pack(kLeast), all, Pack(0.0));
      scale(batch, g, held, 1.0);
      shear.set(g, held * shear(g));
      if (plastic_work_.offset < 0) continue;
      const LocalOutput<field::PlasticWork> writable{plastic_work_.offset};
      const auto work = view(batch, writable);
      const Pack kept = held * work(g);
      batch.ledger->plastic_work -= sum(view(batch, mass_)(g) * (work(g) - kept));
      work.set(g, kept);
    }
  }

 private:
  Input<field::Mass> mass_;
  LocalOutput<field::ShearModulus> shear_;
  LocalOptional<field::PlasticWork> plastic_work_;  // absent: a law that never yields
};

}  // namespace krater::inline KRATER_ISA
