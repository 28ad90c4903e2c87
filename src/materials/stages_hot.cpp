// SPDX-License-Identifier: GPL-3.0-or-later
// Every stage of every law, compiled once per instruction-set level (KRATER_ISA).
#include <limits>

#include "krater/materials/carried_stage.hpp"
#include "krater/materials/energy_heating_stage.hpp"
#include "krater/materials/eos_stage.hpp"
#include "krater/materials/factories.hpp"
#include "krater/materials/heating_stage.hpp"
#include "krater/materials/hyperelastic_stage.hpp"
#include "krater/materials/kinematics_stage.hpp"
#include "krater/materials/law_list.hpp"
#include "krater/materials/return_stage.hpp"
#include "krater/materials/signal_speed_stage.hpp"
#include "krater/materials/start_stage.hpp"
#include "krater/materials/strength_stage.hpp"
#include "krater/materials/trial_stage.hpp"
#include "krater/materials/viscosity_stage.hpp"

namespace krater::inline KRATER_ISA {

namespace {

bool has_deformation_gradient(const Layout& layout) {
  return layout.find(field::DeformationGradient::info.name) != nullptr;
}

bool has_voids(const Layout& layout) {
  return layout.find(field::VoidVolume::info.name) != nullptr;
}

template <class Law, bool carries>
Stage* make_eos(const Law& law, double spall_strength, Layout& layout) {
  if (has_voids(layout)) return new EosStage<Law, carries, true>{law, spall_strength, layout};
  return new EosStage<Law, carries, false>{law, spall_strength, layout};
}

/// The stage of a law, by its family.
template <class Law>
Stage* make_stage(const double* values, const MaterialConstants& constants, Layout& layout) {
  const Law law = make_law<Law>(values, constants);
  if constexpr (WholeStress<Law>) {
    if (has_deformation_gradient(layout)) {
      return new HyperelasticStage<Law, false>{law, constants, layout};
    }
    return new HyperelasticStage<Law, true>{law, constants, layout};
  } else if constexpr (Law::family == Family::strength) {
    return new StrengthStage<Law>{law, constants, layout};
  } else if constexpr (Law::family == Family::eos) {
    return make_eos<Law, false>(law, std::numeric_limits<double>::infinity(), layout);
  } else if constexpr (Law::family == Family::damage) {
    return nullptr;  // several stages: make_part
  } else if constexpr (Law::family == Family::viscosity) {
    return new ViscosityStage<Law>{law, layout};
  } else if constexpr (requires { Law::needs_eos; }) {
    return nullptr;  // make_energy_heating
  } else {
    static_assert(Law::family == Family::heating);
    return new HeatingStage<Law>{law, constants, layout};
  }
}

using Make = Stage* (*)(const double*, const MaterialConstants&, Layout&);

template <class... Laws>
Stage* make_indexed(LawList<Laws...>, int law, const double* values,
                    const MaterialConstants& constants, Layout& layout) {
  static constexpr Make makers[] = {&make_stage<Laws>...};
  if (law < 0 || law >= LawList<Laws...>::size) return nullptr;
  return makers[law](values, constants, layout);
}

Stage* make(int law, const double* values, const MaterialConstants& constants, Layout& layout) {
  return make_indexed(AllLaws{}, law, values, constants, layout);
}

template <class Law>
Stage* make_carrying(const double* values, const MaterialConstants& constants,
                     double spall_strength, Layout& layout) {
  if constexpr (Law::family == Family::eos) {
    return make_eos<Law, true>(make_law<Law>(values, constants), spall_strength, layout);
  } else {
    return nullptr;
  }
}

template <class... Laws>
Stage* make_carrying_indexed(LawList<Laws...>, int law, const double* values,
                             const MaterialConstants& constants, double spall, Layout& layout) {
  using Maker = Stage* (*)(const double*, const MaterialConstants&, double, Layout&);
  static constexpr Maker makers[] = {&make_carrying<Laws>...};
  if (law < 0 || law >= LawList<Laws...>::size) return nullptr;
  return makers[law](values, constants, spall, layout);
}

Stage* make_carrying_eos(int law, const double* values, const MaterialConstants& constants,
                         double spall_strength, Layout& layout) {
  return make_carrying_indexed(AllLaws{}, law, values, constants, spall_strength, layout);
}

template <class Law>
Stage* make_heating(const EnergyHeatingRequest& r, Layout& layout) {
  if constexpr (Law::family == Family::eos) {
    const Law law = make_law<Law>(r.eos_values, r.constants);
    if (r.carries)
      return new EnergyHeatingStage<Law, true>{law, r.c_v, r.degrades, r.constants, layout};
    return new EnergyHeatingStage<Law, false>{law, r.c_v, r.degrades, r.constants, layout};
  } else {
    return nullptr;
  }
}

template <class... Laws>
Stage* make_heating_indexed(LawList<Laws...>, const EnergyHeatingRequest& r, Layout& layout) {
  using Maker = Stage* (*)(const EnergyHeatingRequest&, Layout&);
  static constexpr Maker makers[] = {&make_heating<Laws>...};
  if (r.eos < 0 || r.eos >= LawList<Laws...>::size) return nullptr;
  return makers[r.eos](r, layout);
}

Stage* make_energy_heating(const EnergyHeatingRequest& request, Layout& layout) {
  return make_heating_indexed(AllLaws{}, request, layout);
}

template <class Law>
Stage* make_start(const PartRequest& r, Layout& layout) {
  const Law law = make_law<Law>(r.values, r.constants);
  const PressureLoss loss = pressure_loss(r.degrades, r.degrade);
  if (r.damaged) return new StartStage<Law, true>{law, loss, r.constants, layout};
  return new StartStage<Law, false>{law, loss, r.constants, layout};
}

/// The part of a law of strength or damage; nullptr where it has none.
template <class Law>
Stage* make_law_part(const PartRequest& r, Layout& layout) {
  if constexpr (Law::family == Family::strength && !WholeStress<Law>) {
    if (r.part == Part::start) return make_start<Law>(r, layout);
  }
  if constexpr (Yielding<Law>) {
    const Law law = make_law<Law>(r.values, r.constants);
    if (r.part == Part::flow_stress) return new FlowStressStage<Law>{law, r.constants, layout};
    if (r.part == Part::plastic_return)
      return new PlasticReturnStage<Law>{law, r.constants, layout};
    if (r.part == Part::rate_return) return new RateReturnStage<Law>{law, r.constants, layout};
  } else if constexpr (Law::family == Family::damage) {
    const Law law = make_law<Law>(r.values, r.constants);
    if (r.part == Part::growth) return new GrowthStage<Law>{law, r.constants, layout};
  }
  return nullptr;
}

template <class RateForm>
Stage* make_trial(const PartRequest& r, Layout& layout) {
  if (r.damaged) return new TrialStage<RateForm, true>{r.degrades, layout};
  return new TrialStage<RateForm, false>{r.degrades, layout};
}

Stage* make_trial_of_rate(const PartRequest& r, Layout& layout) {
  switch (r.rate) {
    case Rate::truesdell:
      return make_trial<TruesdellRate>(r, layout);
    case Rate::truesdell_projected:
      return make_trial<TruesdellProjectedRate>(r, layout);
    case Rate::jaumann:
      return make_trial<JaumannRate>(r, layout);
    case Rate::green_naghdi:
      return make_trial<GreenNaghdiRate>(r, layout);
  }
  return nullptr;
}

template <bool dilates>
Stage* make_carried(const PartRequest& r, Layout& layout) {
  if (r.damaged) return new CarriedStage<dilates>{r.degrades, r.degrade, layout};
  return new SoundStage<dilates>{layout};
}

template <class... Laws>
Stage* make_part_indexed(LawList<Laws...>, const PartRequest& r, Layout& layout) {
  using Maker = Stage* (*)(const PartRequest&, Layout&);
  static constexpr Maker makers[] = {&make_law_part<Laws>...};
  if (r.part == Part::trial) return make_trial_of_rate(r, layout);
  if (r.part == Part::carried)
    return has_voids(layout) ? make_carried<true>(r, layout) : make_carried<false>(r, layout);
  return r.law < 0 || r.law >= LawList<Laws...>::size ? nullptr : makers[r.law](r, layout);
}

Stage* make_part(const PartRequest& request, Layout& layout) {
  return make_part_indexed(AllLaws{}, request, layout);
}

Stage* make_kinematics(Layout& layout) {
  if (has_deformation_gradient(layout)) return new KinematicsStage<true>{layout};
  return new KinematicsStage<false>{layout};
}

Stage* make_signal_speed(double q_lin, double q_quad, Layout& layout) {
  return new SignalSpeedStage{q_lin, q_quad, layout};
}

constexpr StageFactory factory{
    make, make_part, make_carrying_eos, make_energy_heating, make_kinematics, make_signal_speed};

}  // namespace

}  // namespace krater::inline KRATER_ISA

namespace krater {

const StageFactory* KRATER_CONCAT(stage_factory_, KRATER_ISA)() { return &factory; }

}  // namespace krater
