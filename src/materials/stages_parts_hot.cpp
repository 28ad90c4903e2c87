// SPDX-License-Identifier: GPL-3.0-or-later
// The deviator in several stages: damage, spall, other rates (compiled once per instruction-set
// level).
#include "krater/materials/stages/carried_stage.hpp"
#include "krater/materials/stages/hyperelastic_stage.hpp"
#include "krater/materials/stages/return_stage.hpp"
#include "krater/materials/stages/start_stage.hpp"
#include "krater/materials/stages/trial_stage.hpp"
#include "materials/stage_makers.hpp"

namespace krater::inline KRATER_ISA {

namespace {

template <class Law>
Stage* make_start(const PartRequest& r, Layout& layout) {
  const Law law = make_law<Law>(r.values, r.constants);
  const PressureLoss loss = pressure_loss(r.degrades, r.degrade);
  if (r.integrity == Integrity::damaged)
    return new StartStage<Law, true>{law, loss, r.constants, layout};
  return new StartStage<Law, false>{law, loss, r.constants, layout};
}

template <class Law>
Stage* make_law_part(const PartRequest& r, Layout& layout) {
  if constexpr (Law::family == Family::strength && !WholeStress<Law>) {
    if (r.part == Part::start) return make_start<Law>(r, layout);
    if (r.part == Part::plastic_return && !Yielding<Law>) return new ElasticReturnStage{layout};
  }
  if constexpr (Coupled<Law>) {
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
  switch (r.integrity) {
    case Integrity::sound:
      return new TrialStage<RateForm, Integrity::sound>{r.degrades, layout};
    case Integrity::failing:
      return new TrialStage<RateForm, Integrity::failing>{r.degrades, layout};
    case Integrity::damaged:
      return new TrialStage<RateForm, Integrity::damaged>{r.degrades, layout};
  }
  return nullptr;
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
  switch (r.integrity) {
    case Integrity::sound:
      return new SoundStage<dilates>{layout};
    case Integrity::failing:
      return new CarriedStage<dilates, false>{r.degrades, r.degrade, layout};
    case Integrity::damaged:
      return new CarriedStage<dilates, true>{r.degrades, r.degrade, layout};
  }
  return nullptr;
}

}  // namespace

Stage* make_part(const PartRequest& r, Layout& layout) {
  if (r.part == Part::trial) return make_trial_of_rate(r, layout);
  if (r.part == Part::carried)
    return r.dilates ? make_carried<true>(r, layout) : make_carried<false>(r, layout);
  return stage_of(AllLaws{}, r.law,
                  [&]<class Law>() -> Stage* { return make_law_part<Law>(r, layout); });
}

}  // namespace krater::inline KRATER_ISA
