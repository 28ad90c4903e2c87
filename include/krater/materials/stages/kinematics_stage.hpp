// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// First stage: from the map of the step f = I + dt L to volume, density and strain (theory 1, 3).
///   j = det f,  j_bar = j (1 + a/2)/(1 - a/2) with a the extra dilatation of cell averaging,
///   rho_{n+1} = rho_n / j_bar,  H = (f - I)[(f + I)/2]^-1.
/// The strain of a step is sym H, never sym(dt L): a spinning body would drift.
/// The tensor M of a point's domain (kinematics/mpm/domain.hpp) is carried here too: f M f^T.
/// rho, v and tr D use the averaged volume change; the deviator uses the plain f.
#pragma once

#include "krater/materials/batch_access.hpp"
#include "krater/materials/stage.hpp"

namespace krater::inline KRATER_ISA {

template <class Real>
struct VolumeStep {
  Real j;      ///< det f
  Real j_bar;  ///< averaged volume ratio
};

template <class Real>
KRATER_FORCE_INLINE VolumeStep<Real> volume_step(const Mat3<Real>& dtL, Real extra_dilatation) {
  const Real j = det_minus_one(dtL) + 1.0;
  return {j, j * fma(Real(0.5), extra_dilatation, Real(1.0)) /
                 fnma(Real(0.5), extra_dilatation, Real(1.0))};
}

/// sym H, H = dtL (I + dtL/2)^-1.
template <class Real>
KRATER_FORCE_INLINE Sym3<Real> strain_step(const Mat3<Real>& dtL) {
  Mat3<Real> middle = Real(0.5) * dtL;
  middle.xx = middle.xx + 1.0;
  middle.yy = middle.yy + 1.0;
  middle.zz = middle.zz + 1.0;
  return sym(dtL * inverse(middle));
}

/// F_{n+1} = f F_n.
template <class Real>
KRATER_FORCE_INLINE Mat3<Real> advance_deformation(const Mat3<Real>& dtL, const Mat3<Real>& F) {
  const Mat3<Real> d = dtL * F;
  return {F.xx + d.xx, F.xy + d.xy, F.xz + d.xz, F.yx + d.yx, F.yy + d.yy,
          F.yz + d.yz, F.zx + d.zx, F.zy + d.zy, F.zz + d.zz};
}

/// `tracks_F`: the deformation gradient is a column of this body; `tracks_M`: the domain is one,
/// and the gather does not carry it.
template <bool tracks_F, bool tracks_M>
class KinematicsStage final : public Stage {
 public:
  explicit KinematicsStage(Layout& layout)
      : dtL_{layout.local_input<field::StepGradient>("kinematics")},
        extra_{layout.local_optional<field::ExtraDilatation>()},
        strain_{layout.local_output<field::StrainStep>("kinematics")},
        volumes_{layout.local_output<field::SpecificVolumes>("kinematics")},
        rate_{layout.local_output<field::DilatationRate>("kinematics")},
        work_{layout.local_output<field::SpecificWork>("kinematics")},
        rho_{layout.state<field::Density>(0.0, "kinematics")},
        F_{tracks_F ? layout.state<field::DeformationGradient>(0.0, "kinematics").offset : -1},
        M_{tracks_M ? layout.state<field::Domain>(0.0, "kinematics").offset : -1} {}

  void apply(const BatchData& batch) const override {
    const auto dtL_p = view(batch, dtL_);
    const auto a_p = view(batch, extra_);
    const auto dE_p = view(batch, strain_);
    const auto v_p = view(batch, volumes_);
    const auto trD_p = view(batch, rate_);
    const auto w_p = view(batch, work_);
    const auto rho_p = view(batch, rho_);
    const Pack per_dt = Pack(1.0 / batch.dt);
    for (int g = 0; g < batch.groups; ++g) {
      const Mat3<Pack> dtL = load_mat3(dtL_p, g);
      const Pack a = a_p(g);
      const VolumeStep<Pack> volume = volume_step(dtL, a);
      const Pack rho = rho_p(g);
      const Pack v = 1.0 / rho;
      report(batch, FaultKind::inverted, g, !(volume.j > Pack(0.0)) | !(volume.j_bar > Pack(0.0)));
      rho_p.set(g, rho / volume.j_bar);
      v_p.set(g, 0, v);
      v_p.set(g, 1, v * volume.j_bar);
      trD_p.set(g, (trace(dtL) + a) * per_dt);
      w_p.set(g, Pack(0.0));
      store_sym3(dE_p, g, strain_step(dtL));
      if constexpr (tracks_F) {
        const auto F_p = view(batch, F_);
        store_mat3(F_p, g, advance_deformation(dtL, load_mat3(F_p, g)));
      }
      if constexpr (tracks_M) {
        const auto M_p = view(batch, M_);
        const Sym3<Pack> M = load_sym3(M_p, g);
        store_sym3(M_p, g, M + push_forward_change(dtL, M));
      }
    }
  }

 private:
  LocalInput<field::StepGradient> dtL_;
  LocalOptional<field::ExtraDilatation> extra_;
  LocalOutput<field::StrainStep> strain_;
  LocalOutput<field::SpecificVolumes> volumes_;
  LocalOutput<field::DilatationRate> rate_;
  LocalOutput<field::SpecificWork> work_;
  State<field::Density> rho_;
  State<field::DeformationGradient> F_;
  State<field::Domain> M_;
};

}  // namespace krater::inline KRATER_ISA
